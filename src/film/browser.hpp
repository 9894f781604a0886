// A headless Chromium with one page, driven by the DevTools protocol over a socket: no port is
// opened.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "src/film/child.hpp"
#include "src/page/json.hpp"

namespace manyworlds::film {

using page::Json;

class Browser {
 public:
  // What it writes lies in `folder`. Throws FilmError, and Stopped where go_on says no, as all do.
  Browser(const std::filesystem::path& folder, GoOn go_on);

  // Opens a file with what stands behind '#' in its address, in a window of that size.
  void open(const std::filesystem::path& page, const std::string& fragment, int width, int height);

  // Evaluates an expression in the page; answer() waits until its promise is kept, and has its
  // value. Several may be asked at once.
  int ask(const std::string& expression);
  Json answer(int question);

  void close();  // in good order; without it the browser is ended with the object

 private:
  int send(const std::string& method, Json parameters);
  Json reply(int id);
  Json call(const std::string& method, Json parameters) { return reply(send(method, parameters)); }
  void receive();
  [[noreturn]] void fail_ended();

  Child child_;
  std::string buffer_;        // received, and not yet read
  std::size_t searched_ = 0;  // of it, without an end of a message
  std::map<int, Json> replies_;
  std::string session_;  // of the page
  bool loaded_ = false;
  int last_ = 0;
};

}  // namespace manyworlds::film
