#include "src/live/session.hpp"

#include <utility>

#include "src/page/json.hpp"

namespace manyworlds::live {
namespace {

constexpr auto kPatience = std::chrono::milliseconds(300);
constexpr int kMaxPerSecond = 1000;       // messages
constexpr std::size_t kMaxOutgoing = 64;  // of which one is a frame
constexpr std::size_t kMaxReason = 120;   // bytes of a close frame

}  // namespace

Session::Session(beast::tcp_stream stream, int page, Hub& hub, const Head& head, const Sizes& sizes,
                 std::function<void(int)> gone)
    : socket_(std::move(stream)),
      pace_(socket_.get_executor()),
      patience_(socket_.get_executor()),
      page_(page),
      hub_(hub),
      head_(head),
      sizes_(sizes),
      gone_(std::move(gone)) {}

void Session::accept(const http::request<http::empty_body>& request) {
  beast::get_lowest_layer(socket_).expires_never();
  // Pings find those that are gone without a word.
  websocket::stream_base::timeout times;
  times.handshake_timeout = std::chrono::seconds(10);
  times.idle_timeout = std::chrono::seconds(30);
  times.keep_alive_pings = true;
  socket_.set_option(times);
  socket_.read_message_max(4 * kMaxMessage);  // beyond that it is cut off without a word
  socket_.auto_fragment(false);
  socket_.async_accept(request, [self = shared_from_this()](const beast::error_code& error) {
    if (error) return self->end();
    self->read();
  });
}

void Session::read() {
  socket_.async_read(incoming_, [self = shared_from_this()](const beast::error_code& error,
                                                            std::size_t) { self->on_read(error); });
}

void Session::on_read(const beast::error_code& error) {
  if (error) return end();
  if (!closing_) {
    try {
      if (!socket_.got_text()) throw BadMessage("messages must be text");
      if (incoming_.size() > kMaxMessage) throw BadMessage("the message is too long");
      if (too_many()) throw BadMessage("too many messages");
      const std::string text = beast::buffers_to_string(incoming_.data());
      obey(parse_command(text, sizes_));
    } catch (const BadMessage& bad) {
      close(websocket::close_code::policy_error, bad.what());
    } catch (const std::exception&) {  // no memory
      close(websocket::close_code::internal_error, "the message could not be processed");
    }
  }
  incoming_.consume(incoming_.size());
  read();  // also to see the other's answer to a close
}

bool Session::too_many() {
  const Clock::time_point now = Clock::now();
  if (now - second_ >= std::chrono::seconds(1)) second_ = now, in_second_ = 0;
  return ++in_second_ > kMaxPerSecond;
}

void Session::obey(Command command) {
  command.page = page_;
  switch (command.kind) {
    case Command::open:
      opened_ = static_cast<int>(command.number);
      worlds_.clear();
      for (int w = 0; w < opened_; ++w) worlds_.push_back(w);
      seen_ = 0;
      return send(false, head_.of(opened_, *hub_.sizes()));
    case Command::look:
      if (opened_ == 0) throw BadMessage("'show' must follow 'open'");
      if (!command.worlds.empty() && command.worlds.back() >= opened_) {
        throw BadMessage("'worlds' has a world that was not opened");
      }
      if (worlds_ != command.worlds) seen_ = 0;
      worlds_ = std::move(command.worlds);
      interval_ = std::chrono::duration_cast<Clock::duration>(
          std::chrono::duration<double>(1 / command.number));
      if (waits_) ask_for_frame();
      return;
    case Command::frame:
      if (opened_ == 0) throw BadMessage("'frame' must follow 'open'");
      if (waits_) throw BadMessage("a frame is already requested");
      waits_ = true;
      return ask_for_frame();
    default:
      if (!hub_.post(std::move(command)))
        say("busy: too many commands wait for the next step; this one was dropped");
  }
}

// At once, or when the time has come for it.
void Session::ask_for_frame() {
  const Clock::time_point now = Clock::now();
  if (now < next_frame_) {
    pace_.expires_at(next_frame_);
    pace_.async_wait([self = shared_from_this()](const beast::error_code& error) {
      if (!error && self->waits_ && !self->closing_) self->ask_for_frame();
    });
    return;
  }
  hub_.want(page_, worlds_, seen_);
  captured();
  if (!waits_) return;
  // Where nothing steps, what there is has to do.
  patience_.expires_after(kPatience);
  patience_.async_wait([self = shared_from_this()](const beast::error_code& error) {
    if (!error) self->captured(!self->head_.steps_itself());
  });
}

void Session::captured(bool older) {
  if (!waits_ || closing_ || Clock::now() < next_frame_) return;
  const Hub::Captured newest = hub_.newest(worlds_, older);
  if (newest == nullptr || newest->version == seen_) return;
  waits_ = false;
  seen_ = newest->version;
  next_frame_ = Clock::now() + interval_;
  hub_.forget(page_);
  send(true, frame_of(*newest, sizes_, worlds_));
}

void Session::resized() {
  if (opened_ > 0) send(false, head_.sizes_of(opened_, *hub_.sizes()));
}

void Session::say(const std::string& text) {
  send(false,
       page::Json{{"said", text}}.dump(-1, ' ', false, page::Json::error_handler_t::replace));
}

void Session::send(bool binary, std::string data) {
  if (closing_ || ended_) return;
  if (outgoing_.size() >= kMaxOutgoing) {
    return close(websocket::close_code::policy_error, "the page does not read its messages");
  }
  outgoing_.push_back({binary, std::move(data)});
  if (outgoing_.size() == 1) write();
}

void Session::write() {
  socket_.binary(outgoing_.front().binary);
  socket_.async_write(asio::buffer(outgoing_.front().data),
                      [self = shared_from_this()](const beast::error_code& error, std::size_t) {
                        if (error) return self->end();
                        self->outgoing_.pop_front();
                        if (!self->outgoing_.empty() && !self->closing_) self->write();
                      });
}

void Session::close(websocket::close_code code, const std::string& why) {
  if (closing_ || ended_) return;
  closing_ = true;
  pace_.cancel(), patience_.cancel();
  const std::string reason = why.substr(0, kMaxReason);
  socket_.async_close(websocket::close_reason(code, reason),
                      [self = shared_from_this()](const beast::error_code&) { self->end(); });
}

void Session::end() {
  if (ended_) return;
  ended_ = true;
  closing_ = true;
  pace_.cancel(), patience_.cancel();
  hub_.forget(page_);
  Command last;
  last.kind = Command::gone;
  last.page = page_;
  hub_.post(std::move(last));
  beast::error_code ignored;
  beast::get_lowest_layer(socket_).socket().close(ignored);
  gone_(page_);
}

}  // namespace manyworlds::live
