// Where scenes come from: a name, or an MJCF file.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"

#include "mjcf_file.hpp"

namespace manyworlds::cli {

// The scene of that name, or the one in that file. Anything that ends in .xml or holds a slash is
// taken for a file. Warnings of the reader go to `warnings`, or to standard error. Throws
// InputError: unknown name (with the nearest known one, if one is near), file that cannot be read.
Scene load_scene(const std::string& name_or_file, const MjcfArguments& mjcf,
                 std::vector<std::string>* warnings = nullptr);

}  // namespace manyworlds::cli
