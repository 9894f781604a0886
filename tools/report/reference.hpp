// Short ways to describe the bodies of a case.
#pragma once

#include <cmath>
#include <utility>

#include "manyworlds/batch.hpp"
#include "scenes/builders.hpp"
#include "scenes/world_state.hpp"

namespace manyworlds::report {

using scenes::kPi;
using scenes::position;
using scenes::rotation;
using scenes::spin;
using scenes::up_of;
using scenes::velocity;

inline constexpr double kG = 9.81;  // m/s^2

inline Scene empty(Space space, double gravity = kG) { return scenes::empty_scene(space, gravity); }

// Without friction unless told.
inline Body with_shape(Geometry geometry, const Vec3& position, double friction = 0,
                       double restitution = 0) {
  return scenes::body_of(scenes::shape_of(std::move(geometry), friction, restitution), position);
}
inline Body ground(Space space, double friction = 0, double restitution = 0) {
  return scenes::ground(space, friction, restitution);
}
inline void weigh(Body& body, double mass, const Vec3& moments) {
  body.mass_properties = MassProperties{mass, Vec3::Zero(), moments.asDiagonal()};
}
// A body that touches nothing.
inline Body lump(Space space, double mass, const Vec3& moments, const Vec3& position) {
  Body body = with_shape(scenes::cube_of(space, 0.1), position);
  body.shapes[0].filter.mask = 0;
  weigh(body, mass, moments);
  return body;
}

// n + 1 upright unit links on the ground whose tips n level ones join: all turn alike (IFToMM A02).
inline Scene loops_of_four_bars(int n) {
  Scene scene = empty(Space::planar);
  const auto link = [&](const Vec3& at, const Vec3& velocity, bool upright) {
    Body body = lump(Space::planar, 1, Vec3::Constant(1.0 / 12), at);
    if (upright) {
      body.rotation = Quat(Eigen::AngleAxisd(kPi / 2, Vec3::UnitZ()));
      body.angular_velocity = {0, 0, -1};
    }
    body.linear_velocity = velocity;
    scene.add(body);
  };
  for (int i = 0; i <= n; ++i) link({static_cast<double>(i), 0.5, 0}, {0.5, 0, 0}, true);
  for (int i = 0; i < n; ++i) link({i + 0.5, 1, 0}, {1, 0, 0}, false);
  const auto pin = [&](int a, int b, double x, double y) {
    Frame at;
    at.position = {x, y, 0};
    scene.add(joint_at(scene, BodyId(a), BodyId(b), at, HingeJoint{}));
  };
  for (int i = 0; i <= n; ++i) pin(-1, i, i, 0);
  for (int i = 0; i < n; ++i) pin(i, n + 1 + i, i, 1), pin(i + 1, n + 1 + i, i + 1, 1);
  return scene;
}

inline double angle_between(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2 * std::atan2(d.vec().norm(), std::abs(d.w()));
}

}  // namespace manyworlds::report
