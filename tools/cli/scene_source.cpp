#include "scene_source.hpp"

#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "manyworlds/nearest.hpp"
#include "manyworlds/scenes.hpp"

#include "options.hpp"

namespace manyworlds::cli {
namespace {

bool looks_like_a_file(const std::string& text) {
  return text.ends_with(".xml") || text.find('/') != std::string::npos;
}

}  // namespace

Scene load_scene(const std::string& name_or_file, const MjcfArguments& mjcf,
                 std::vector<std::string>* warnings) {
  if (const scenes::Entry* entry = scenes::find(name_or_file)) return entry->make();
  try {
    if (std::optional<Scene> scene = scenes::sized(name_or_file)) return std::move(*scene);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
  if (looks_like_a_file(name_or_file)) return load_mjcf_file(name_or_file, mjcf, warnings);
  std::vector<std::string> names;
  for (const scenes::Entry& entry : scenes::all()) names.emplace_back(entry.name);
  const std::optional<std::string> near = nearest(name_or_file, names);
  throw InputError(fmt::format("unknown scene '{}'{} ('manyworlds scenes' lists all)", name_or_file,
                               near ? fmt::format("; did you mean '{}'?", *near) : ""));
}

}  // namespace manyworlds::cli
