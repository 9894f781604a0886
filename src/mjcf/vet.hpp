// Checks a model before MuJoCo sees it, and gathers all the files that it needs.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/mjcf.hpp"

namespace manyworlds::mjcf {

struct VirtualFile {
  std::string name;   // absolute, as the model names it
  std::string label;  // where it was read
  std::string bytes;
};

// A model that names no file but those beside it.
struct Vetted {
  std::string xml;
  std::vector<VirtualFile> files;
};

// Both throw MjcfError.
Vetted vet_file(const std::filesystem::path& file, const MjcfOptions& options);
Vetted vet_string(std::string_view xml, const std::string& label, const MjcfOptions& options);

}  // namespace manyworlds::mjcf
