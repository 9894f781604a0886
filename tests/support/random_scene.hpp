// Random valid scenes: some bodies of every kind fall, fly and pile up in a room without a ceiling.
// A scene follows from its seed alone, draw by draw, so a failure is rerun by its seed.
#pragma once

#include <cstdint>

#include "manyworlds/scene.hpp"

namespace manyworlds::test {

struct RandomScene {
  Scene scene;
  // Nothing overlaps at first and no kinematic body moves: mechanical energy can only fall.
  bool passive = true;
  // Bodies may move farther in a step than they are long, and weigh a hundred times as much as
  // those that they land on: soft contacts then give way, and energy and walls are not to be
  // counted on.
  bool rough = false;
  double top_speed = 0;  // m/s, that no body should exceed, generously
  double unit = 1;       // m, of the largest bounding radius
};

RandomScene random_scene(std::uint64_t seed);

// How far a dynamic body's centre of mass is behind the ground or a wall, m; negative: it is where
// it should be. Obstacles in the room, which have two sides, do not count.
double behind_walls(const RandomScene& random, const Vec3& center);

}  // namespace manyworlds::test
