#include "view_page.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "built_page.hpp"
#include "options.hpp"

namespace manyworlds::cli {

namespace fs = std::filesystem;

fs::path empty_page() {
  if (const auto page = find_page(kViewerPage)) return *page;
  throw InputError("view: " + why_no_page(kViewerPage));
}

namespace {

// Runs a program, with what it prints left out. Its exit code; nothing where it is not there.
std::optional<int> run_quietly(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t streams;
  posix_spawn_file_actions_init(&streams);
  for (const int number : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&streams, number, "/dev/null", O_RDWR, 0);
  }
  pid_t child = 0;
  const int error =
      posix_spawnp(&child, arguments[0], &streams, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&streams);
  if (error != 0) return std::nullopt;
  int status = 0;
  while (waitpid(child, &status, 0) != child) {
    if (errno != EINTR) return -1;
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

PictureSize parse_size(const std::string& text) {
  constexpr int kLeast = 64, kMost = 8192;
  PictureSize size;
  int end = 0;
  const bool read = std::sscanf(text.c_str(), "%5dx%5d%n", &size.width, &size.height, &end) == 2 &&
                    static_cast<std::size_t>(end) == text.size();
  const auto fits = [](int n) { return n >= kLeast && n <= kMost; };
  if (read && fits(size.width) && fits(size.height)) return size;
  throw InputError(
      fmt::format("--size: must be like 1280x720, each {} to {}, is '{}'", kLeast, kMost, text));
}

void take_picture(const fs::path& page, const std::string& fragment, const PictureSize& size,
                  const fs::path& png) {
  std::vector<std::string> browsers = {"chromium", "chromium-browser", "google-chrome"};
  if (const char* given = std::getenv("CHROMIUM"); given != nullptr && *given != 0) {
    browsers = {given};
  }
  // Its own name in the folder, since the browser says of no failure what it was.
  const fs::path part = png.string() + fmt::format(".part-{}.png", getpid());
  // Time is virtual: it stands still while the page has work to do. Without a graphics card its
  // software takes over; and as root there is no sandbox.
  std::vector<std::string> words = {"",
                                    "--headless",
                                    "--hide-scrollbars",
                                    "--use-angle=swiftshader",
                                    "--enable-unsafe-swiftshader",
                                    "--virtual-time-budget=8000",
                                    fmt::format("--window-size={},{}", size.width, size.height),
                                    "--screenshot=" + fs::absolute(part).string()};
  if (geteuid() == 0) words.push_back("--no-sandbox");
  words.push_back("file://" + fs::absolute(page).string() + "#" + fragment);
  for (const std::string& browser : browsers) {
    words.front() = browser;
    const std::optional<int> code = run_quietly(words);
    std::error_code error;
    if (!code || *code == 127) continue;
    fs::rename(part, png, error);
    if (!error) return;
    throw InputError(
        fmt::format("--png: {} made no picture '{}' (exit code {})", browser, png.string(), *code));
  }
  throw InputError(fmt::format("--png: wants a browser, and found no {}; Debian has it as chromium",
                               fmt::join(browsers, ", ")));
}

bool open_in_browser(const fs::path& page) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) return false;
  std::string program = "xdg-open", file = page.string();
  char* arguments[] = {program.data(), file.data(), nullptr};
  pid_t child = 0;
  if (posix_spawnp(&child, program.c_str(), nullptr, nullptr, arguments, environ) != 0)
    return false;
  int status = 0;
  return waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace manyworlds::cli
