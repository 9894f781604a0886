// Who may have the page: whoever knows its token, on this machine, from the page itself.
//
// Any site that the user visits can make the browser send requests to 127.0.0.1, and with DNS
// rebinding make them look like its own. The token keeps out those who do not know the address,
// Host those whose name merely points here, Origin those whose page it is not.
#pragma once

#include <string>
#include <string_view>

namespace manyworlds::live {

// 128 random bits of the system's as 32 hexadecimal digits. Throws LiveError where it has none.
std::string make_token();

// Takes as long for one that is wrong at its beginning as for one that is wrong at its end.
bool same_token(std::string_view given, std::string_view token);

class Access {
 public:
  Access(std::string token, int port);

  enum class Place { nowhere, page, socket };
  // What is at a target, "/<token>/" and "/<token>/socket".
  Place place_of(std::string_view target) const;
  bool host_allowed(std::string_view host) const;      // 127.0.0.1:port or localhost:port
  bool origin_allowed(std::string_view origin) const;  // http:// and one of these
  std::string url() const;
  int port() const { return port_; }
  // What the page may load, for Content-Security-Policy.
  std::string sockets() const;

 private:
  std::string token_;
  int port_;
  std::string by_number_, by_name_;  // hosts
};

}  // namespace manyworlds::live
