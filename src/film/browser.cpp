#include "src/film/browser.hpp"

#include <unistd.h>

#include <chrono>
#include <string_view>
#include <utility>
#include <vector>

#include "manyworlds/film.hpp"
#include "src/film/programs.hpp"

namespace manyworlds::film {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr auto kPatience = std::chrono::minutes(5);  // for one frame, on a slow machine in software
constexpr auto kEnd = std::chrono::seconds(5);

std::vector<std::string> words(const std::string& program, const fs::path& folder) {
  std::vector<std::string> out = {
      program, "--headless", "--remote-debugging-pipe",
      "--user-data-dir=" + (folder / "browser").string(),
      // Without a graphics card its software takes over.
      "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist",
      "--hide-scrollbars", "--no-first-run", "--no-default-browser-check",
      "--disable-background-networking", "--disable-breakpad", "--disable-component-update",
      "--disable-default-apps", "--disable-extensions", "--disable-sync",
      // It keeps frames in shared memory, which containers have little of.
      "--disable-dev-shm-usage"};
  if (geteuid() == 0) out.emplace_back("--no-sandbox");  // it has none for root
  return out;
}

// A path inside an address.
std::string encoded(std::string_view path) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/-._~";
  std::string out;
  for (const char c : path) {
    if (kPlain.find(c) != std::string_view::npos) {
      out += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    out += '%';
    out += "0123456789ABCDEF"[byte >> 4];
    out += "0123456789ABCDEF"[byte & 15];
  }
  return out;
}

// "no such world" of "Error: no such world\n    at ...".
std::string first_line(const std::string& text) {
  const std::string line = text.substr(0, text.find('\n'));
  constexpr std::string_view kError = "Error: ";
  return line.starts_with(kError) ? line.substr(kError.size()) : line;
}

}  // namespace

Browser::Browser(const fs::path& folder, GoOn go_on)
    : child_(words(browser_program(), folder), {3, 4}, folder / "browser.log", std::move(go_on)) {
  const Json made = call("Target.createTarget", {{"url", "about:blank"}});
  const Json attached =
      call("Target.attachToTarget", {{"targetId", made.at("targetId")}, {"flatten", true}});
  session_ = attached.at("sessionId").get<std::string>();
  call("Inspector.enable", Json::object());  // tells where the page crashes
  call("Page.enable", Json::object());
}

void Browser::open(const fs::path& page, const std::string& fragment, int width, int height) {
  call("Emulation.setDeviceMetricsOverride",
       {{"width", width}, {"height", height}, {"deviceScaleFactor", 1}, {"mobile", false}});
  loaded_ = false;
  const std::string url = "file://" + encoded(fs::absolute(page).string()) + "#" + fragment;
  const Json gone = call("Page.navigate", {{"url", url}});
  if (gone.contains("errorText")) {
    throw FilmError(child_.name() + " cannot open '" + page.string() +
                    "': " + gone.at("errorText").get<std::string>());
  }
  while (!loaded_) receive();
}

int Browser::ask(const std::string& expression) {
  return send("Runtime.evaluate",
              {{"expression", expression}, {"awaitPromise", true}, {"returnByValue", true}});
}

Json Browser::answer(int question) {
  Json found = reply(question);
  if (const auto thrown = found.find("exceptionDetails"); thrown != found.end()) {
    const Json exception = thrown->value("exception", Json::object());
    throw FilmError("the page: " +
                    first_line(exception.value("description", thrown->value("text", "failed"))));
  }
  return std::move(found.at("result")["value"]);
}

void Browser::close() {
  session_.clear();
  send("Browser.close", Json::object());
  child_.wait(Clock::now() + kEnd);
}

int Browser::send(const std::string& method, Json parameters) {
  Json message = {{"id", ++last_}, {"method", method}, {"params", std::move(parameters)}};
  if (!session_.empty()) message["sessionId"] = session_;
  std::string text = message.dump(-1, ' ', true, Json::error_handler_t::replace);
  text += '\0';
  if (!child_.send(text)) fail_ended();
  return last_;
}

Json Browser::reply(int id) {
  for (;;) {
    if (const auto found = replies_.find(id); found != replies_.end()) {
      Json message = std::move(found->second);
      replies_.erase(found);
      if (const auto error = message.find("error"); error != message.end()) {
        throw FilmError(child_.name() + ": " + error->value("message", "refused a command"));
      }
      return std::move(message["result"]);
    }
    receive();
  }
}

// Reads one message.
void Browser::receive() {
  const auto deadline = Clock::now() + kPatience;
  std::size_t end;
  while ((end = buffer_.find('\0', searched_)) == std::string::npos) {
    searched_ = buffer_.size();
    if (!child_.receive(buffer_, deadline)) {
      if (Clock::now() < deadline) fail_ended();
      throw FilmError(child_.name() + " does not answer");
    }
  }
  Json message = Json::parse(buffer_.begin(), buffer_.begin() + static_cast<std::ptrdiff_t>(end),
                             nullptr, false);
  buffer_.erase(0, end + 1);
  searched_ = 0;
  if (!message.is_object()) throw FilmError(child_.name() + " sent an invalid message");
  const std::string method = message.value("method", "");
  if (method == "Page.loadEventFired") loaded_ = true;
  if (method == "Inspector.targetCrashed") {
    throw FilmError("the page crashed in " + child_.name() + "; it may have run out of memory");
  }
  if (const auto id = message.find("id"); id != message.end()) {
    const int number = id->get<int>();
    replies_[number] = std::move(message);
  }
}

void Browser::fail_ended() {
  const int code = child_.wait(Clock::now() + kEnd);
  throw FilmError(child_.name() + " ended (exit code " + std::to_string(code) + ")" +
                  child_.last_words());
}

}  // namespace manyworlds::film
