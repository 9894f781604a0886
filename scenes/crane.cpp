// A crane: a trolley on a rail, a rope that swings below it, and a load on the rope's winch. The
// rope is a light rod on a hinge along which the load slides, because drives act on sliders.
#include <cmath>
#include <string>

#include "scenes/makers.hpp"
#include "scenes/parts.hpp"

namespace manyworlds::scenes {

Scene crane() {
  constexpr double kHeight = 12, kRope = 6;  // m, of the rail; from the rail to the load
  Scene scene = planar_scene("crane");
  scene.options.density = 20;
  scene.options.bounds = Eigen::AlignedBox3d(Vec3(-20, -0.5, -1), Vec3(20, 20, 1));
  scene.add(ground(Space::planar));

  const BodyId trolley = add_body(scene, "trolley", {0, kHeight, 0}, Polygon::box(0.8, 0.3));
  scene.bodies.back().jitter.position = {2, 0, 0};
  Body rope = named_body("rope", {0, kHeight - kRope / 2, 0}, Capsule{0.04, kRope / 2});
  rope.jitter.with = trolley;
  rope.jitter.linear_velocity = {0.5, 0, 0};
  rope.shapes.back().filter.mask = 0;
  const BodyId line = scene.add(rope);
  Body load = named_body("load", {0, kHeight - kRope, 0}, Polygon::box(0.5, 0.5));
  load.linear_drag = 0.3;  // what lets it come to rest
  load.jitter.with = trolley;
  const BodyId hook = scene.add(load);

  const SliderJoint rail{Limit{-8, 8, std::nullopt}, Drive{0, 0, std::nullopt, 2000}};
  const JointId drive = scene.add(joint_at(scene, {}, trolley, frame_at(0, kHeight), rail));
  scene.add(joint_at(scene, trolley, line, frame_at(0, kHeight), HingeJoint{}));
  const double half = std::sqrt(0.5);
  const Frame down{load.position, Quat(half, 0, 0, -half)};  // its x points down
  const SliderJoint winch{Limit{-4, 5, std::nullopt}, Drive{0, 0, std::nullopt, 1000}};
  const JointId hoist = scene.add(joint_at(scene, line, hook, down, winch));
  scene.controls = {speed_of("trolley", drive, 3, 1), speed_of("lower", hoist, 1, 0)};

  for (int i = 0; i < 3; ++i) {
    add_body(scene, "crate" + std::to_string(i), {4.5 + 1.2 * (i % 2), 0.5 + i / 2, 0},
             Polygon::box(0.5, 0.5));
    scene.bodies.back().jitter.position = {0.05, 0, 0};
  }
  return scene;
}

}  // namespace manyworlds::scenes
