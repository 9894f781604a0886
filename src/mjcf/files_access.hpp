// MuJoCo's own model of files that were read and checked, for what steps it beside ours.
#pragma once

#include "manyworlds/mjcf.hpp"
#include "src/mjcf/mujoco_library.hpp"

namespace manyworlds::mjcf {

struct FilesAccess {
  // The model that MjcfFiles::compile makes its scene of. Throws MjcfError.
  static ModelPtr mujoco_model(const MjcfFiles& from);
};

}  // namespace manyworlds::mjcf
