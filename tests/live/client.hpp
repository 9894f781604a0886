// A page without a browser: HTTP and WebSocket by hand, on a blocking socket.
#pragma once

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

#include "manyworlds/live.hpp"
#include "tests/record/support.hpp"

namespace manyworlds::test {

// A folder with a page that has what a Live looks for.
struct LiveFolder : Folder {
  LiveFolder() {
    std::ofstream(*this / "viewer.html")
        << "<meta name=\"manyworlds-page\" content=\"1\"><meta content=\"connect-src blob:\">"
           "<!-- manyworlds: recordings -->";
  }
  LiveOptions options() const { return {.page = *this / "viewer.html", .folder = path()}; }
};

class Connection {
 public:
  explicit Connection(int port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in place{};
    place.sin_family = AF_INET;
    place.sin_port = htons(static_cast<std::uint16_t>(port));
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    timeval patience{30, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    if (connect(socket_, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
      ::close(socket_);
      throw std::runtime_error("no connection");
    }
  }
  ~Connection() { ::close(socket_); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void send(std::string_view bytes) {
    while (!bytes.empty()) {
      const ssize_t sent = ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
      if (sent <= 0) return;  // closed by the other
      bytes.remove_prefix(static_cast<std::size_t>(sent));
    }
  }
  // Exactly so many bytes, fewer where it is closed.
  std::string receive(std::size_t size) {
    std::string out(size, '\0');
    std::size_t got = 0;
    while (got < size) {
      const ssize_t n = ::recv(socket_, out.data() + got, size - got, 0);
      if (n <= 0) break;
      got += static_cast<std::size_t>(n);
    }
    out.resize(got);
    return out;
  }
  // Up to the empty line.
  std::string receive_head() {
    std::string out;
    while (!out.ends_with("\r\n\r\n")) {
      const std::string c = receive(1);
      if (c.empty()) break;
      out += c;
    }
    return out;
  }

 private:
  int socket_;
};

// The status line's number for a request by hand; 0: none came.
inline int status_of(int port, const std::string& request) {
  Connection connection(port);
  connection.send(request);
  const std::string head = connection.receive_head();
  return head.size() > 12 ? std::stoi(head.substr(9, 3)) : 0;
}

class Page {
 public:
  // Patient: tries again where there are too many pages, of which some are gone but not yet missed.
  enum Patience { impatient, patient };
  explicit Page(const Live& live, Patience patience = impatient) {
    for (std::string status = "503"; status != "101";) {
      connection_.emplace(live.port());
      const std::string url = live.url();
      const std::string host = "127.0.0.1:" + std::to_string(live.port());
      connection_->send("GET " + url.substr(url.find('/', 7)) + "socket HTTP/1.1\r\nHost: " + host +
                        "\r\nOrigin: http://" + host +
                        "\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                        "Sec-WebSocket-Version: 13\r\n"
                        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n");
      status = (connection_->receive_head() + std::string(12, ' ')).substr(9, 3);
      if (status == "101" || (patience == patient && status == "503")) continue;
      throw std::runtime_error("no upgrade: " + status);
    }
  }

  void send(std::string_view text, char opcode = 1) {
    std::string out(1, static_cast<char>(0x80 | opcode));
    if (text.size() < 126) {
      out += static_cast<char>(0x80 | text.size());
    } else {
      out += static_cast<char>(0x80 | 127);
      for (int byte = 7; byte >= 0; --byte) out += static_cast<char>(text.size() >> (8 * byte));
    }
    out.append(4, '\0');  // the mask
    connection_->send(out.append(text));
  }

  struct Received {
    int opcode = 0;  // 1: text, 2: binary, 8: closed
    std::string data = {};
  };
  Received receive() {
    const std::string head = connection_->receive(2);
    if (head.size() < 2) return {8, "  cut off"};
    auto size = static_cast<std::uint64_t>(head[1] & 127);
    if (size >= 126) {
      const std::string more = connection_->receive(size == 126 ? 2 : 8);
      size = 0;
      for (const char c : more) size = size << 8 | static_cast<unsigned char>(c);
    }
    Received out{head[0] & 15, connection_->receive(size)};
    return out.opcode == 9 ? receive() : out;  // pings
  }
  // What it says as it closes the page.
  std::string farewell() {
    Received got = receive();
    while (got.opcode != 8) got = receive();
    return got.data.size() > 2 ? got.data.substr(2) : "";
  }

 private:
  std::optional<Connection> connection_;
};

}  // namespace manyworlds::test
