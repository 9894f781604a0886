// Small scenes in which every kind of pair meets within a few steps and differently in each world:
// what the tests of equal bits run on.
#pragma once

#include "tests/support/scenes.hpp"

namespace manyworlds::test {

Scene crowd(Space space, int bodies = 8);

// Six corners, none of them opposite to another.
inline Hull wedge_hull(double size) {
  return {{size * Vec3(-1, -0.8, -0.6), size * Vec3(1, -0.9, -0.7), size * Vec3(0.1, 1, -0.6),
           size * Vec3(-0.7, -0.5, 0.8), size * Vec3(0.6, -0.6, 0.9), size * Vec3(0, 0.7, 0.7)}};
}

// The same with capsules among the bodies and fixed, in the plane over a terrain and a segment;
// with polygons instead of rectangles if wished, in space with cylinders and hulls.
Scene capsule_crowd(Space space, bool polygons = false);

}  // namespace manyworlds::test
