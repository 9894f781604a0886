// Short ways to describe the bodies of a case, and to look at world 0.
#pragma once

#include <cmath>
#include <utility>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::report {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kG = 9.81;  // m/s^2

inline Vec3 up_of(Space space) { return space == Space::planar ? Vec3(0, 1, 0) : Vec3(0, 0, 1); }

inline Scene empty(Space space, double gravity = kG) {
  Scene scene;
  scene.space = space;
  scene.options.gravity = -gravity * up_of(space);
  return scene;
}

inline Body with_shape(Geometry geometry, const Vec3& position, double friction = 0,
                       double restitution = 0) {
  Body body;
  Shape shape;
  shape.geometry = std::move(geometry);
  shape.material = {friction, restitution};
  body.shapes = {shape};
  body.position = position;
  return body;
}
inline Body ground(Space space, double friction = 0, double restitution = 0) {
  const Geometry plane = space == Space::planar ? Geometry(HalfPlane{}) : Geometry(Plane{});
  Body body = with_shape(plane, Vec3::Zero(), friction, restitution);
  body.motion = Motion::fixed;
  return body;
}
inline void weigh(Body& body, double mass, const Vec3& moments) {
  body.mass_properties = MassProperties{mass, Vec3::Zero(), moments.asDiagonal()};
}
// A body that touches nothing.
inline Body lump(Space space, double mass, const Vec3& moments, const Vec3& position) {
  Body body = with_shape(space == Space::planar ? Geometry(Polygon::box(0.1, 0.1))
                                                : Geometry(Box{Vec3::Constant(0.1)}),
                         position);
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

inline Vec3 field_of(const Batch& batch, Field field, int body) {
  const Space space = batch.plan().scene().space;
  std::vector<double> all(static_cast<std::size_t>(batch.bodies(0) * components(field, space)));
  batch.read(field, 0, all);
  const int n = components(field, space);
  Vec3 out = Vec3::Zero();
  if (n == 1) {
    out.z() = all[static_cast<std::size_t>(body)];
  } else {
    for (int i = 0; i < n; ++i) out[i] = all[static_cast<std::size_t>(body * n + i)];
  }
  return out;
}
inline Vec3 position(const Batch& b, int body) { return field_of(b, Field::position, body); }
inline Vec3 velocity(const Batch& b, int body) { return field_of(b, Field::linear_velocity, body); }
inline Vec3 spin(const Batch& b, int body) { return field_of(b, Field::angular_velocity, body); }
inline Quat rotation(const Batch& batch, int body) {
  const bool planar = batch.plan().scene().space == Space::planar;
  const std::size_t n = planar ? 2 : 4, i = n * static_cast<std::size_t>(body);
  std::vector<double> v(static_cast<std::size_t>(batch.bodies(0)) * n);
  batch.read(Field::orientation, 0, v);
  if (!planar) return Quat(v[i], v[i + 1], v[i + 2], v[i + 3]);
  return Quat(Eigen::AngleAxisd(std::atan2(v[i + 1], v[i]), Vec3::UnitZ()));
}
inline double angle_between(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2 * std::atan2(d.vec().norm(), std::abs(d.w()));
}

}  // namespace manyworlds::report
