#include "scene_source.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "manyworlds/scenes.hpp"

#include "options.hpp"

#ifdef MW_HAVE_MJCF
#include "manyworlds/mjcf.hpp"
#endif

namespace manyworlds::cli {
namespace {

bool looks_like_a_file(const std::string& text) {
  return text.ends_with(".xml") || text.find('/') != std::string::npos;
}

// The reader's own message for an absent file differs from one MuJoCo version to the next.
void require_readable(const std::string& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw InputError(fmt::format("cannot read '{}': no such file", path));
  }
  if (std::filesystem::is_directory(status)) {
    throw InputError(fmt::format("cannot read '{}': it is a directory", path));
  }
  if (!std::ifstream(path)) {
    throw InputError(fmt::format("cannot read '{}': it cannot be opened", path));
  }
}

#ifdef MW_HAVE_MJCF
Scene load_file(const std::string& path) {
  try {
    MjcfResult result = load_mjcf(path);
    for (const std::string& warning : result.warnings) {
      fmt::print(stderr, "manyworlds: warning: {}\n", warning);
    }
    return std::move(result.scene);
  } catch (const MjcfError& error) {
    throw InputError(error.what());
  }
}
#else
Scene load_file(const std::string& path) {
  throw InputError(fmt::format("cannot read '{}': this program was built without MJCF", path));
}
#endif

}  // namespace

bool reads_mjcf() {
#ifdef MW_HAVE_MJCF
  return true;
#else
  return false;
#endif
}

Scene load_scene(const std::string& name_or_file) {
  if (const scenes::Entry* entry = scenes::find(name_or_file)) return entry->make();
  try {
    if (std::optional<Scene> scene = scenes::sized(name_or_file)) return std::move(*scene);
  } catch (const std::invalid_argument& error) {
    throw InputError(error.what());
  }
  if (looks_like_a_file(name_or_file)) {
    require_readable(name_or_file);
    return load_file(name_or_file);
  }
  throw InputError(
      fmt::format("unknown scene '{}'; did you mean '{}'? ('manyworlds scenes' lists all)",
                  name_or_file, scenes::nearest(name_or_file)));
}

}  // namespace manyworlds::cli
