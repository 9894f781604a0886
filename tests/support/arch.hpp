// An arch of loose blocks.
#pragma once

#include <cmath>

#include "tests/support/scenes.hpp"

namespace manyworlds::test {

// Half a ring of voussoirs with 1 m inside, on the ground.
inline Scene arch(Space space, int count, double thick) {
  Scene scene = empty_scene(space);
  scene.add(ground(space, 1));
  const auto on = [](double radius, double angle) {
    return Vec2(radius * Vec2(std::cos(angle), std::sin(angle)));
  };
  for (int i = 0; i < count; ++i) {
    const double from = kPi * i / count, to = kPi * (i + 1) / count;
    const Vec2 outline[] = {on(1, from), on(1 + thick, from), on(1 + thick, to), on(1, to)};
    Vec2 middle = Vec2::Zero();
    for (const Vec2& p : outline) middle += p / 4;
    Polygon polygon;
    Hull hull;
    for (const Vec2& p : outline) {
      const Vec2 q = p - middle;
      polygon.vertices.push_back(q);
      for (const double side : {-0.2, 0.2}) hull.vertices.push_back({q.x(), side, q.y()});
    }
    const bool planar = space == Space::planar;
    const Geometry geometry = planar ? Geometry(polygon) : Geometry(hull);
    const Vec3 at = planar ? Vec3(middle.x(), middle.y(), 0) : Vec3(middle.x(), 0, middle.y());
    scene.add(body_of(shape_of(geometry, 1), at));
  }
  return scene;
}

}  // namespace manyworlds::test
