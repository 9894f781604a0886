#include "tests/support/crowd.hpp"

namespace manyworlds::test {

Scene crowd(Space space, int bodies) {
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

Scene capsule_crowd(Space space, bool polygons) {
  const bool planar = space == Space::planar;
  Scene scene = crowd(space, 12);
  scene.name += "-capsules";
  for (std::size_t i = 2; i < scene.bodies.size(); i += 3)
    scene.bodies[i].shapes[0].geometry = Capsule{0.25, 0.3};
  scene.add(
      body_of(shape_of(Capsule{0.2, 0.4}, 0.4), Vec3(1, 0, 0) + 0.2 * up_of(space), Motion::fixed));
  scene.add(body_of(shape_of(round_of(space, 0.3), 0.4), Vec3(-1, 0, 0), Motion::fixed));
  if (!planar) {
    // Cylinders and hulls in the other places, of all kinds.
    if (!polygons) return scene;
    for (std::size_t i = 3; i < 14; i += 3)
      scene.bodies[i].shapes[0].geometry = Cylinder{0.35, 0.3};
    for (std::size_t i = 4; i < 14; i += 3) scene.bodies[i].shapes[0].geometry = wedge_hull(0.4);
    scene.add(body_of(shape_of(Cylinder{0.3, 0.3}, 0.4), Vec3(0, 1, 0.1), Motion::fixed));
    scene.add(body_of(shape_of(wedge_hull(0.4), 0.4), Vec3(0, -1, 0.1), Motion::fixed));
    return scene;
  }
  scene.add(body_of(shape_of(Segment{{-2, 0.6}, {-1, 0.1}}, 0.4), Vec3::Zero(), Motion::fixed));
  scene.add(body_of(shape_of(Terrain{{{-4, 1}, {-2, 0.1}, {-1, 0.2}, {0, 0.1}, {2, 0.1}, {4, 1}}}),
                    Vec3::Zero(), Motion::fixed));
  if (polygons) {
    for (std::size_t i = 3; i < scene.bodies.size(); i += 3)
      if (scene.bodies[i].motion == Motion::dynamic)
        scene.bodies[i].shapes[0].geometry = Polygon{{{-0.4, -0.3}, {0.4, -0.3}, {0, 0.4}}};
  }
  return scene;
}

}  // namespace manyworlds::test
