#include "src/live/access.hpp"

#include <sys/random.h>

#include <array>
#include <cstdint>
#include <utility>

#include "manyworlds/live.hpp"

namespace manyworlds::live {

std::string make_token() {
  std::array<std::uint8_t, 16> bytes;
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw LiveError("live: the system returned no random numbers");
  }
  constexpr char kDigits[] = "0123456789abcdef";
  std::string out;
  for (const std::uint8_t byte : bytes) out += kDigits[byte >> 4], out += kDigits[byte & 15];
  return out;
}

bool same_token(std::string_view given, std::string_view token) {
  unsigned differs = given.size() != token.size();
  for (std::size_t i = 0; i < token.size(); ++i) {
    const char c = i < given.size() ? given[i] : '\0';
    differs |= static_cast<unsigned>(static_cast<unsigned char>(c ^ token[i]));
  }
  // Not to be worked out early.
  volatile unsigned result = differs;
  return result == 0;
}

Access::Access(std::string token, int port)
    : token_(std::move(token)),
      port_(port),
      by_number_("127.0.0.1:" + std::to_string(port)),
      by_name_("localhost:" + std::to_string(port)) {}

Access::Place Access::place_of(std::string_view target) const {
  if (target.empty() || target.front() != '/') return Place::nowhere;
  target.remove_prefix(1);
  const std::size_t end = target.find('/');
  if (!same_token(target.substr(0, end), token_) || end == target.npos) return Place::nowhere;
  const std::string_view rest = target.substr(end + 1);
  return rest.empty() ? Place::page : rest == "socket" ? Place::socket : Place::nowhere;
}

bool Access::host_allowed(std::string_view host) const {
  return host == by_number_ || host == by_name_;
}

bool Access::origin_allowed(std::string_view origin) const {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && host_allowed(origin.substr(kScheme.size()));
}

std::string Access::url() const { return "http://" + by_number_ + "/" + token_ + "/"; }

std::string Access::sockets() const { return "ws://" + by_number_ + " ws://" + by_name_; }

}  // namespace manyworlds::live
