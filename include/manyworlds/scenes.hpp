// Named scenes shared by tests, benchmarks, the program and the docs.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds::scenes {

struct Entry {
  const char* name;
  const char* summary;  // one line
  bool standard;        // one of the standard benchmark scenes
  Scene (*make)();
};

const std::vector<Entry>& all();           // in the order of lists and menus
const Entry* find(std::string_view name);  // nullptr if unknown
// Standard scenes of other sizes: "pyramid2d:100" (boxes in the lowest row), "bin-spheres:1000" and
// "bin-boxes:1000" (bodies). Empty for other names. Throws std::invalid_argument if the size is
// invalid.
std::optional<Scene> sized(std::string_view name);
std::string nearest(std::string_view name);  // the known name with the smallest edit distance

}  // namespace manyworlds::scenes
