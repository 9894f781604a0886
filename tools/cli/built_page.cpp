#include "built_page.hpp"

#include <cstdlib>
#include <system_error>

#include <fmt/format.h>

#include "options.hpp"

namespace manyworlds::cli {

namespace fs = std::filesystem;

std::optional<fs::path> find_page(const BuiltPage& page) {
  std::error_code ignored;
  if (const char* given = std::getenv(page.variable); given != nullptr && *given != 0) {
    if (fs::is_regular_file(given, ignored)) return given;
    throw InputError(fmt::format("{} is '{}', which is not a file", page.variable, given));
  }
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path prefix = program.parent_path().parent_path();
  for (const fs::path& file : {prefix / "share" / "manyworlds" / page.file,  // installed
                               prefix / "viewer" / page.file,                // in a build tree
                               prefix / page.file}) {                        // in a Python package
    if (fs::is_regular_file(file, ignored)) return file;
  }
  return std::nullopt;
}

std::string why_no_page(const BuiltPage& page) {
  return fmt::format(
      "the page was not built with this program: tools/viewer in the repository builds it, with "
      "Node 18 or later and npm; {}={} sets the path of another one",
      page.variable, page.file);
}

}  // namespace manyworlds::cli
