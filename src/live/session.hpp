// One page that is connected: what it asks for, and what it is sent. All on the server's thread.
#pragma once

#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "src/live/boost.hpp"
#include "src/live/head.hpp"
#include "src/live/hub.hpp"

namespace manyworlds::live {

class Session : public std::enable_shared_from_this<Session> {
 public:
  // `gone` is called once, when the page is.
  Session(beast::tcp_stream stream, int page, Hub& hub, const Head& head, const Sizes& sizes,
          std::function<void(int page)> gone);

  void accept(const http::request<http::empty_body>& request);
  int page() const { return page_; }
  // There is a new capture; sizes have changed.
  void captured(bool older = false);
  void resized();
  void say(const std::string& text);
  void close(websocket::close_code code, const std::string& why);

 private:
  using Clock = std::chrono::steady_clock;
  struct Outgoing {
    bool binary;
    std::string data;
  };

  void read();
  void on_read(const beast::error_code& error);
  void obey(Command command);
  bool too_many();
  void ask_for_frame();
  void send(bool binary, std::string data);
  void write();
  void end();

  websocket::stream<beast::tcp_stream> socket_;
  asio::steady_timer pace_, patience_;
  int page_;
  Hub& hub_;
  const Head& head_;
  const Sizes& sizes_;
  std::function<void(int)> gone_;

  beast::flat_buffer incoming_;
  std::deque<Outgoing> outgoing_;  // the first is being sent
  bool closing_ = false, ended_ = false;

  int opened_ = 0;           // worlds of the head that it has
  std::vector<int> worlds_;  // that it shows
  Clock::duration interval_ = std::chrono::milliseconds(33);
  Clock::time_point next_frame_ = {};
  bool waits_ = false;  // for a frame
  std::uint64_t seen_ = 0;

  Clock::time_point second_ = {};
  int in_second_ = 0;  // messages
};

}  // namespace manyworlds::live
