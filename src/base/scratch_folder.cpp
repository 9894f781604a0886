#include "src/base/scratch_folder.hpp"

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <string>
#include <system_error>
#include <thread>

#include "src/base/output_file.hpp"

namespace manyworlds {

namespace fs = std::filesystem;

fs::path make_private_folder() {
  std::error_code error;
  const fs::path parent = fs::temp_directory_path(error);
  if (error) throw FileError("TMPDIR", reason_of(error.value()));
  std::string name = (parent / "manyworlds-XXXXXX").string();
  if (mkdtemp(name.data()) == nullptr) throw FileError(parent, reason_of(errno));
  return name;
}

ScratchFolder::~ScratchFolder() {
  if (kept_) return;
  // A program that was ended a moment ago may have a file more to write.
  for (int attempt = 0; attempt < 20; ++attempt) {
    std::error_code error;
    fs::remove_all(path_, error);
    if (!error) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace manyworlds
