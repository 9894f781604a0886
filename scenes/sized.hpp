// Standard scenes in other sizes, up to thousands of bodies in one world.
#pragma once

#include "manyworlds/scene.hpp"

namespace manyworlds::scenes {

// 2D: rows of `base`, base - 1, ... and 1 unit squares: base (base + 1) / 2 bodies.
Scene pyramid(int base);

// 3D: balls of 0.5 m, or cubes of 0.8 m in any orientation, in layers over a bin about as wide as
// they are high.
Scene bin_of_spheres(int bodies);
Scene bin_of_boxes(int bodies);

}  // namespace manyworlds::scenes
