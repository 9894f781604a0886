#include "view_page.hpp"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "options.hpp"

namespace manyworlds::cli {

namespace fs = std::filesystem;

fs::path empty_page() {
  std::error_code ignored;
  if (const char* given = std::getenv("MANYWORLDS_VIEWER"); given != nullptr && *given != 0) {
    if (fs::is_regular_file(given, ignored)) return given;
    throw InputError(fmt::format("MANYWORLDS_VIEWER is '{}', which is no file", given));
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path prefix = program.parent_path().parent_path();
  for (const fs::path& file :
       {prefix / "share" / "manyworlds" / "viewer.html", prefix / "viewer" / "viewer.html"}) {
    if (fs::is_regular_file(file, ignored)) return file;
  }
  throw InputError(
      "view: the page was not built with this program: tools/viewer in the repository builds it, "
      "with "
      "Node 18 or later and npm; MANYWORLDS_VIEWER=viewer.html names one that is elsewhere");
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
