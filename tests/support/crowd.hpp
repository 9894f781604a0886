// A small scene in which every kind of pair meets within a few steps and differently in each
// world: what the tests of equal bits run on.
#pragma once

#include "tests/support/scenes.hpp"

namespace manyworlds::test {

inline Scene crowd(Space space, int bodies = 8) {
  const bool planar = space == Space::planar;
  Scene scene = empty_scene(space);
  scene.name = planar ? "crowd2d" : "crowd";
  scene.add(ground(space, 0.5, 0.2));
  // A fixed block in the middle, so that there are fixed candidates of every kind.
  scene.add(body_of(shape_of(cube_of(space, 0.3), 0.4), 0.1 * up_of(space), Motion::fixed));
  for (int i = 0; i < bodies; ++i) {
    const double x = (i % 2 - 0.5) * 1.1, y = (i / 2 % 2 - 0.5) * 1.1;
    const double height = 0.7 + (planar ? 0.55 : 1.1) * (planar ? i / 2 * 2 : i / 4);
    const Vec3 at = planar ? Vec3(x, height, 0) : Vec3(x, y, height);
    const bool round = (i + i / 4) % 2 == 0;
    Body body = body_of(
        shape_of(round ? round_of(space, 0.45) : cube_of(space, 0.4), 0.5, i % 3 == 0 ? 0.5 : 0),
        at);
    body.linear_velocity = -1.5 * Vec3(at.x(), planar ? 0 : at.y(), 0);
    body.angular_velocity = planar ? Vec3(0, 0, i - 3.0) : Vec3(i - 2.0, 1, 3.0 - i);
    body.jitter.position = planar ? Vec3(0.2, 0.1, 0) : Vec3(0.2, 0.2, 0.1);
    body.jitter.linear_velocity = planar ? Vec3(1, 1, 0) : Vec3(1, 1, 1);
    body.jitter.angle = 1.5;
    body.jitter.any_orientation = !planar;
    body.linear_drag = i == 1 ? 0.1 : 0;
    body.angular_drag = i == 2 ? 0.2 : 0;
    scene.add(body);
  }
  return scene;
}

}  // namespace manyworlds::test
