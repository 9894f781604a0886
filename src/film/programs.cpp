#include "src/film/programs.hpp"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <vector>

#include "manyworlds/film.hpp"
#include "src/base/float_mode.hpp"

namespace manyworlds {

namespace film {
namespace {

namespace fs = std::filesystem;

bool can_run(const fs::path& file) {
  std::error_code ignored;
  return fs::is_regular_file(file, ignored) && access(file.c_str(), X_OK) == 0;
}

// As a shell finds it; empty where it does not.
std::string find(const std::string& name) {
  if (name.find('/') != std::string::npos) return can_run(name) ? name : std::string();
  const char* path = std::getenv("PATH");
  std::string_view folders = path != nullptr ? path : "/usr/local/bin:/usr/bin:/bin";
  for (bool more = true; more;) {
    const std::size_t end = folders.find(':');
    more = end != std::string_view::npos;
    const fs::path file = fs::path(folders.substr(0, end)) / name;
    if (can_run(file)) return file.string();
    if (more) folders.remove_prefix(end + 1);
  }
  return {};
}

std::string find_first(const char* variable, std::vector<std::string> names,
                       const std::string& what, const std::string& package,
                       const std::string& chosen = {}) {
  const char* given = std::getenv(variable);
  if (given != nullptr && *given != 0) names = {given};
  if (!chosen.empty()) names = {chosen};
  std::string tried;
  for (const std::string& name : names) {
    const std::string file = find(name);
    if (!file.empty()) return file;
    tried += (tried.empty() ? "" : ", ") + name;
  }
  throw FilmError("needs " + what + ", found none of " + tried + "; install " + package +
                  ", or set " + variable + " to its path");
}

}  // namespace

std::string browser_program() {
  return find_first("CHROMIUM", {"chromium", "chromium-browser", "google-chrome"}, "a browser",
                    "Debian's chromium");
}
std::string encoder_program(const std::string& given) {
  return find_first("FFMPEG", {"ffmpeg"}, "an encoder",
                    "Debian's ffmpeg or PyPI's imageio-ffmpeg (found by Python only)", given);
}

}  // namespace film

void find_browser() { film::browser_program(); }
void find_encoder() { film::encoder_program(); }

}  // namespace manyworlds
