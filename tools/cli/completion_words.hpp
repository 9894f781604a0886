// Words that complete names of scenes and paths of options.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/options.hpp"
#include "manyworlds/scenes.hpp"

#include "set_option.hpp"

namespace manyworlds::cli {

inline std::vector<std::string> all_scene_names() {
  std::vector<std::string> names;
  for (const scenes::Entry& entry : scenes::all()) names.emplace_back(entry.name);
  return names;
}

// As --set takes them: "contact.slop".
inline std::vector<std::string> option_paths() {
  std::vector<std::string> paths;
  for (const OptionLine& line : option_lines(Options())) paths.push_back(line.path);
  return paths;
}

}  // namespace manyworlds::cli
