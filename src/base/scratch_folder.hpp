// A new folder that only its owner may enter, and which is gone with the object if it is not to
// stay: nobody else can have put a file or a link there.
#pragma once

#include <filesystem>

namespace manyworlds {

// Makes one in the temporary folder. Throws FileError (output_file.hpp).
std::filesystem::path make_private_folder();

class ScratchFolder {
 public:
  ScratchFolder() : path_(make_private_folder()) {}
  ~ScratchFolder();
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const char* file) const { return path_ / file; }
  void keep() { kept_ = true; }  // it stays

 private:
  std::filesystem::path path_;
  bool kept_ = false;
};

}  // namespace manyworlds
