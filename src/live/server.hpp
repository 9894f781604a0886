// HTTP and WebSocket on 127.0.0.1, by Boost.Beast, on a thread of its own.
#pragma once

#include <memory>
#include <string>

#include "src/live/access.hpp"
#include "src/live/head.hpp"
#include "src/live/hub.hpp"

namespace manyworlds::live {

class Server {
 public:
  // What is served; it must outlive the server.
  struct Content {
    Hub& hub;
    const Head& head;
    const Sizes& sizes;
    std::string page;  // viewer.html without data
  };
  // Listens at once. Throws LiveError.
  Server(Content content, const std::string& token, int port);
  ~Server();  // ends the thread
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const Access& access() const;
  int pages() const;

  struct Impl;

 private:
  std::unique_ptr<Impl> impl_;
};

// The page as it is served: with the word that it is live, and a policy that lets it open its
// socket and nothing else. Throws LiveError for what is no page of this version.
std::string live_page(std::string empty, const Access& access);

}  // namespace manyworlds::live
