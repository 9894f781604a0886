// Newton's cradle without the strings.
#pragma once

#include "manyworlds/scene.hpp"

namespace manyworlds::scenes {

// Five equal planar balls of radius 0.5 m and 1 kg/m^2 in a row along x, `gap` m apart, without
// gravity, friction or loss. The first `moving` (1 to 4) come with 1 m/s towards the others; as
// many of the last ones shall leave with 1 m/s. Precondition: gap >= 0.
Scene newton_cradle(int moving, double gap);

}  // namespace manyworlds::scenes
