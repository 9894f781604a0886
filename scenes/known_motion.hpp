// Scenes whose motion is known, for tests and reports. Gravity is 9.81 m/s^2.
#pragma once

#include <cmath>
#include <utility>

#include "scenes/builders.hpp"

namespace manyworlds::scenes {

inline constexpr double kG = 9.81;  // m/s^2

// A body on ground that slopes down along x, by gravity that leans.
inline Scene incline(Space space, double slope, double friction, Geometry geometry, double height) {
  Scene scene = empty_scene(space, 0);
  scene.options.gravity = kG * (std::sin(slope) * Vec3::UnitX() - std::cos(slope) * up_of(space));
  scene.add(ground(space, friction));
  scene.add(body_of(shape_of(std::move(geometry), friction), height * up_of(space)));
  return scene;
}

// n + 1 upright unit links on the ground whose tips n level ones join; all uprights keep the same
// angle (IFToMM A02).
inline Scene loops_of_four_bars(int n) {
  Scene scene = empty_scene(Space::planar, kG);
  for (int i = 0; i <= n; ++i) {
    Body link = uniform_rod(Space::planar, 1, 1, {static_cast<double>(i), 0.5, 0});
    link.rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
    link.angular_velocity = {0, 0, -1};
    link.linear_velocity = {0.5, 0, 0};
    scene.add(link);
  }
  for (int i = 0; i < n; ++i) {
    Body link = uniform_rod(Space::planar, 1, 1, {i + 0.5, 1, 0});
    link.linear_velocity = {1, 0, 0};
    scene.add(link);
  }
  const auto pin = [&](int a, int b, double x, double y) {
    scene.add(joint_at(scene, BodyId(a), BodyId(b), frame_at(x, y), HingeJoint{}));
  };
  for (int i = 0; i <= n; ++i) pin(-1, i, i, 0);
  for (int i = 0; i < n; ++i) pin(i, n + 1 + i, i, 1), pin(i + 1, n + 1 + i, i + 1, 1);
  return scene;
}

}  // namespace manyworlds::scenes
