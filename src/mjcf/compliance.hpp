// How soft a constraint is: MuJoCo's solref and solimp.
#pragma once

#include "manyworlds/compliance.hpp"
#include "src/mjcf/mujoco_library.hpp"

namespace manyworlds::mjcf {

// As they are written: MuJoCo, too, mixes those of two geoms before it brings them into range.
inline Compliance compliance(const mjtNum* solref, const mjtNum* solimp) {
  return {.time_constant = solref[0],
          .damping_ratio = solref[1],
          .min_impedance = solimp[0],
          .max_impedance = solimp[1],
          .width = solimp[2],
          .midpoint = solimp[3],
          .power = solimp[4]};
}

}  // namespace manyworlds::mjcf
