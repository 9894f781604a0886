// Who may have a page.
#include "src/live/access.hpp"

#include <set>

#include <catch2/catch.hpp>

#include "manyworlds/live.hpp"
#include "src/live/server.hpp"

namespace manyworlds::live {

TEST_CASE("tokens are long, random and compared whole", "[live][fast]") {
  std::set<std::string> tokens;
  for (int i = 0; i < 100; ++i) tokens.insert(make_token());
  CHECK(tokens.size() == 100);
  const std::string token = *tokens.begin();
  CHECK(token.size() == 32);
  CHECK(token.find_first_not_of("0123456789abcdef") == token.npos);
  CHECK(same_token(token, token));
  CHECK_FALSE(same_token("", token));
  CHECK_FALSE(same_token(token.substr(1), token));
  CHECK_FALSE(same_token(token + "0", token));
  CHECK_FALSE(same_token(token + std::string(1, '\0'), token));
  for (std::size_t i = 0; i < token.size(); ++i) {
    std::string other = token;
    other[i] = other[i] == '0' ? '1' : '0';
    CHECK_FALSE(same_token(other, token));
  }
}

TEST_CASE("places, hosts and origins are those of the page alone", "[live][fast]") {
  const Access access("0123456789abcdef", 4711);
  using Place = Access::Place;
  CHECK(access.url() == "http://127.0.0.1:4711/0123456789abcdef/");
  CHECK(access.place_of("/0123456789abcdef/") == Place::page);
  CHECK(access.place_of("/0123456789abcdef/socket") == Place::socket);
  for (const char* target :
       {"", "/", "//", "*", "/0123456789abcdef", "/0123456789abcdeg/", "/0123456789abcdef/x",
        "/0123456789abcdef//", "/0123456789abcdef/socket/", "/socket", "0123456789abcdef/",
        "/0123456789abcdef/?", "http://127.0.0.1:4711/0123456789abcdef/"}) {
    INFO(target);
    CHECK(access.place_of(target) == Place::nowhere);
  }
  CHECK(access.host_allowed("127.0.0.1:4711"));
  CHECK(access.host_allowed("localhost:4711"));
  for (const char* host : {"", "127.0.0.1", "localhost", "127.0.0.1:4712", "evil.example:4711",
                           "127.0.0.1:4711.evil.example", "[::1]:4711", "LOCALHOST:4711 "}) {
    INFO(host);
    CHECK_FALSE(access.host_allowed(host));
    CHECK_FALSE(access.origin_allowed(std::string("http://") + host));
  }
  CHECK(access.origin_allowed("http://127.0.0.1:4711"));
  CHECK(access.origin_allowed("http://localhost:4711"));
  for (const char* origin : {"", "null", "https://127.0.0.1:4711", "http://127.0.0.1:4711/",
                             "127.0.0.1:4711", "http://localhost"}) {
    INFO(origin);
    CHECK_FALSE(access.origin_allowed(origin));
  }
}

TEST_CASE("the page is told that it is live, and may open its socket alone", "[live][fast]") {
  const Access access("00", 80);
  const std::string empty =
      "<meta name=\"manyworlds-page\" content=\"1\"><meta content=\"connect-src blob:\">"
      "<!-- manyworlds: recordings -->";
  const std::string page = live_page(empty, access);
  CHECK(page.find("id=\"mw-live\"") != page.npos);
  CHECK(page.find("connect-src blob: ws://127.0.0.1:80 ws://localhost:80\"") != page.npos);
  CHECK_THROWS_AS(live_page("<html></html>", access), LiveError);
}

}  // namespace manyworlds::live
