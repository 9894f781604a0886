#include "view_page.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "built_page.hpp"
#include "options.hpp"

namespace manyworlds::cli {

namespace fs = std::filesystem;

fs::path empty_page() {
  if (const auto page = find_page(kViewerPage)) return *page;
  throw InputError("view: " + why_no_page(kViewerPage));
}

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
