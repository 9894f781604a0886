#include "src/live/server.hpp"

#include <atomic>
#include <exception>
#include <map>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "manyworlds/live.hpp"
#include "src/live/boost.hpp"
#include "src/live/session.hpp"

namespace manyworlds::live {
namespace {

constexpr std::size_t kMaxPages = 16;
constexpr int kMaxConnections = 64;
constexpr std::uint32_t kMaxHeader = 8192;  // bytes
constexpr auto kMaxRequest = std::chrono::seconds(10);

// Where in the page the word goes that it is live, what it says of its version, and its policy.
constexpr std::string_view kPlace = "<!-- manyworlds: recordings -->";
constexpr std::string_view kVersion = "<meta name=\"manyworlds-page\" content=\"1\">";
constexpr std::string_view kConnect = "connect-src blob:";

std::string_view view_of(beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

std::string live_page(std::string empty, const Access& access) {
  const std::size_t place = empty.find(kPlace), policy = empty.find(kConnect);
  if (empty.find(kVersion) == empty.npos || place == empty.npos || policy == empty.npos) {
    throw LiveError(
        "live: the page is not of this version; expected viewer.html as viewer/ builds it");
  }
  empty.replace(place, kPlace.size(),
                "<script type=\"application/json\" id=\"mw-live\">{}</script>");
  empty.insert(policy + kConnect.size(), " " + access.sockets());
  return empty;
}

struct Server::Impl {
  Impl(Content what, const std::string& token, int port)
      : content(std::move(what)), acceptor(context), access(token, listen(port)) {
    content.page = live_page(std::move(content.page), access);
    content.hub.listen({
        .captured = [this] { to_all([](Session& s) { s.captured(); }); },
        .said =
            [this](int page, std::string text) {
              to_all([page, text = std::move(text)](Session& s) {
                if (page == 0 || page == s.page()) s.say(text);
              });
            },
        .resized = [this] { to_all([](Session& s) { s.resized(); }); },
    });
    accept();
    try {
      thread = std::thread([this] { serve(); });
    } catch (const std::system_error& error) {
      content.hub.stop_listening();
      throw LiveError(std::string("live: its thread cannot be started: ") + error.what());
    }
  }

  ~Impl() {
    content.hub.stop_listening();
    stopping = true;  // before the last of the pages can be gone
    asio::post(context, [this] {
      beast::error_code ignored;
      acceptor.close(ignored);
      for (const auto& [page, session] : std::map(sessions)) {
        session->close(websocket::close_code::going_away, "the program has ended");
      }
      // Those that do not answer are left.
      deadline.expires_after(std::chrono::milliseconds(500));
      deadline.async_wait([this](const beast::error_code&) { context.stop(); });
      if (sessions.empty()) context.stop();
    });
    thread.join();
  }

  int listen(int port) {
    const tcp::endpoint place(asio::ip::make_address("127.0.0.1"),
                              static_cast<std::uint16_t>(port));
    beast::error_code error;
    acceptor.open(place.protocol(), error);
    if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
    if (!error) acceptor.bind(place, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error) {
      throw LiveError("live: port " + std::to_string(port) + " of 127.0.0.1: " + error.message());
    }
    return acceptor.local_endpoint().port();
  }

  void accept() {
    acceptor.async_accept([this](const beast::error_code& error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error && connections < kMaxConnections) {
        beast::error_code ignored;
        socket.set_option(tcp::no_delay(true), ignored);
        serve(std::move(socket));
      }
      if (acceptor.is_open()) accept();
    });
  }

  // Calls f(session) of each, on the server's thread.
  template <class F>
  void to_all(F f) {
    asio::post(context, [this, f = std::move(f)] {
      for (const auto& [page, session] : std::map(sessions)) f(*session);
    });
  }

  struct Request {
    explicit Request(tcp::socket socket) : stream(std::move(socket)) {
      parser.header_limit(kMaxHeader);
      parser.body_limit(0);
    }
    beast::tcp_stream stream;
    beast::flat_buffer buffer;
    http::request_parser<http::empty_body> parser;
    http::response<http::string_body> response;
  };

  void serve(tcp::socket socket) {
    ++connections;
    const std::shared_ptr<Request> request(new Request(std::move(socket)), [this](Request* r) {
      delete r;
      --connections;
    });
    request->stream.expires_after(kMaxRequest);
    http::async_read(request->stream, request->buffer, request->parser,
                     [this, request](const beast::error_code& error, std::size_t) {
                       if (!error) return answer(request);
                       if (error == http::error::end_of_stream || error == beast::error::timeout)
                         return;
                       respond(request, http::status::bad_request, "the request cannot be read\n");
                     });
  }

  void answer(const std::shared_ptr<Request>& request) {
    const auto& asked = request->parser.get();
    const auto refuse = [&](http::status status, const char* why) {
      respond(request, status, why);
    };
    if (asked.count(http::field::host) != 1 ||
        !access.host_allowed(view_of(asked[http::field::host]))) {
      return refuse(http::status::forbidden, "this host is not served\n");
    }
    const bool socket = websocket::is_upgrade(asked);
    const bool has_origin = asked.count(http::field::origin) > 0;
    if ((socket || has_origin) && (asked.count(http::field::origin) != 1 ||
                                   !access.origin_allowed(view_of(asked[http::field::origin])))) {
      return refuse(http::status::forbidden, "this origin may not open the page\n");
    }
    const Access::Place place = access.place_of(view_of(asked.target()));
    if (place == Access::Place::nowhere) {
      return refuse(http::status::forbidden,
                    "the address is incomplete: open the one that the program printed\n");
    }
    if (asked.method() == http::verb::head) return refuse(http::status::method_not_allowed, "");
    if (asked.method() != http::verb::get) {
      return refuse(http::status::method_not_allowed, "only GET is allowed\n");
    }
    if (place == Access::Place::page) {
      return socket ? refuse(http::status::bad_request, "this address is not a WebSocket\n")
                    : respond(request, http::status::ok, content.page);
    }
    if (!socket) return refuse(http::status::upgrade_required, "this address is a WebSocket\n");
    if (sessions.size() >= kMaxPages) {
      return refuse(http::status::service_unavailable, "too many pages are open\n");
    }
    const int page = ++last_page;
    const auto session = std::make_shared<Session>(std::move(request->stream), page, content.hub,
                                                   content.head, content.sizes, [this](int gone) {
                                                     sessions.erase(gone);
                                                     pages = static_cast<int>(sessions.size());
                                                     if (stopping && sessions.empty())
                                                       context.stop();
                                                   });
    sessions.emplace(page, session);
    pages = static_cast<int>(sessions.size());
    session->accept(asked);
  }

  // An exception (out of memory) drops the request that caused it; the server continues.
  void serve() noexcept {
    for (;;) {
      try {
        context.run();
        return;
      } catch (const std::exception&) {
      }
    }
  }

  void respond(const std::shared_ptr<Request>& request, http::status status, std::string text) {
    auto& response = request->response;
    const bool page = status == http::status::ok;
    response.version(11);
    response.result(status);
    response.keep_alive(false);
    response.set(http::field::content_type, page ? "text/html; charset=utf-8" : "text/plain");
    response.set(http::field::cache_control, "no-store");
    response.set("Referrer-Policy", "no-referrer");
    response.set("X-Content-Type-Options", "nosniff");
    response.set("Cross-Origin-Resource-Policy", "same-origin");
    response.set("Cross-Origin-Opener-Policy", "same-origin");
    // The rest of the policy is in the page.
    response.set("Content-Security-Policy", "frame-ancestors 'none'");
    response.body() = std::move(text);
    response.prepare_payload();
    request->stream.expires_after(kMaxRequest);
    http::async_write(request->stream, response, [request](const beast::error_code&, std::size_t) {
      beast::error_code ignored;
      request->stream.socket().shutdown(tcp::socket::shutdown_send, ignored);
    });
  }

  Content content;
  int connections = 0;  // requests that are not over, of the server's thread
  asio::io_context context{1};
  tcp::acceptor acceptor;
  Access access;
  asio::steady_timer deadline{context};
  std::map<int, std::shared_ptr<Session>> sessions;  // of the server's thread, as what follows
  int last_page = 0;
  std::atomic<int> pages = 0;
  std::atomic<bool> stopping = false;
  std::thread thread;
};

Server::Server(Content content, const std::string& token, int port)
    : impl_(std::make_unique<Impl>(std::move(content), token, port)) {}
Server::~Server() = default;
const Access& Server::access() const { return impl_->access; }
int Server::pages() const { return impl_->pages; }

}  // namespace manyworlds::live
