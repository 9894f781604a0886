#include "src/base/output_folder.hpp"

#include <system_error>

#include "src/base/float_mode.hpp"
#include "src/base/output_file.hpp"

namespace manyworlds {

namespace {

namespace fs = std::filesystem;

// Why nothing can lie below `path`, which is not made here; empty if it is a folder or nothing.
std::string why_no_folder(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status) || fs::is_directory(status)) return {};
  return fs::is_regular_file(status) ? "is a file, not a folder" : "is not a folder";
}

}  // namespace

void make_folder(const fs::path& folder) {
  const FloatMode mode;
  if (folder.empty()) throw FileError(folder, "is not a folder name");
  for (fs::path path = folder;; path = path.parent_path()) {
    const std::string why = why_no_folder(path);
    if (!why.empty()) throw FileError(path, why);
    if (!path.has_relative_path() || path.parent_path().empty()) break;
  }
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw FileError(folder, "the folder cannot be created: " + reason_of(error.value()));
  if (!fs::is_directory(folder, error)) throw FileError(folder, "is not a folder");
}

}  // namespace manyworlds
