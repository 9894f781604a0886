// Short ways to describe bodies and scenes in tests, and to look at one world of a Batch.
#pragma once

#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::test {

inline constexpr double kPi = 3.14159265358979323846;

// Planar scenes fall along -y, spatial ones along -z.
inline Scene empty_scene(Space space, double gravity = 10) {
  Scene s;
  s.name = "test";
  s.space = space;
  s.options.gravity = space == Space::planar ? Vec3(0, -gravity, 0) : Vec3(0, 0, -gravity);
  return s;
}

inline Shape shape_of(Geometry geometry, double friction = 0.6, double restitution = 0) {
  Shape shape;
  shape.geometry = std::move(geometry);
  shape.material.friction = friction;
  shape.material.restitution = restitution;
  return shape;
}

inline Body body_of(Shape shape, const Vec3& position, Motion motion = Motion::dynamic) {
  Body body;
  body.shapes.push_back(std::move(shape));
  body.position = position;
  body.motion = motion;
  return body;
}

// A sphere or circle, a cube or square, a plane or half-plane: the same word in both spaces.
inline Geometry round_of(Space space, double radius) {
  if (space == Space::planar) return Circle{radius};
  return Sphere{radius};
}
inline Geometry cube_of(Space space, double half) {
  if (space == Space::planar) return Polygon::box(half, half);
  return Box{Vec3(half, half, half)};
}
inline Geometry ground_of(Space space) {
  if (space == Space::planar) return HalfPlane{};
  return Plane{};
}
// A box of these half extents; the plane has the first two.
Geometry box_of(Space space, const Vec3& half);
// A box `side` wide to every side and `height` high, both half extents, m.
Geometry slab_of(Space space, double side, double height);
inline Vec3 up_of(Space space) { return space == Space::planar ? Vec3(0, 1, 0) : Vec3(0, 0, 1); }

inline Body ground(Space space, double friction = 0.6, double restitution = 0) {
  return body_of(shape_of(ground_of(space), friction, restitution), Vec3::Zero(), Motion::fixed);
}

// Values of one field of one world, as [body][component].
inline std::vector<double> values(const Batch& batch, Field field, int world = 0) {
  const Space space = batch.plan(batch.kind_of(world)).scene().space;
  std::vector<double> v(static_cast<std::size_t>(batch.bodies(world) * components(field, space)));
  batch.read(field, world, v);
  return v;
}

inline Space space_of(const Batch& batch) { return batch.plan(0).scene().space; }

inline Vec3 vector_of(const Batch& batch, Field field, int world, int body) {
  const std::vector<double> v = values(batch, field, world);
  const int n = components(field, space_of(batch));
  Vec3 result = Vec3::Zero();
  if (n == 1) {
    result.z() = v[static_cast<std::size_t>(body)];
  } else {
    for (int i = 0; i < n; ++i) result(i) = v[static_cast<std::size_t>(body * n + i)];
  }
  return result;
}
inline Vec3 position(const Batch& b, int world, int body) {
  return vector_of(b, Field::position, world, body);
}
inline Vec3 velocity(const Batch& b, int world, int body) {
  return vector_of(b, Field::linear_velocity, world, body);
}
inline Vec3 spin(const Batch& b, int world, int body) {
  return vector_of(b, Field::angular_velocity, world, body);
}
inline Quat rotation(const Batch& batch, int world, int body) {
  const std::vector<double> v = values(batch, Field::orientation, world);
  const auto i = static_cast<std::size_t>(body);
  if (space_of(batch) == Space::spatial)
    return Quat(v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]);
  return Quat(Eigen::AngleAxisd(std::atan2(v[2 * i + 1], v[2 * i]), Vec3::UnitZ()));
}

// Of a body of the scene instead of a row.
inline int row_of(const Batch& batch, int world, BodyId body) {
  return batch.row(body, batch.kind_of(world));
}
inline BodyId in_row(const Batch& batch, int world, int row) {
  return batch.body_in_row(row, batch.kind_of(world));
}
inline Vec3 position(const Batch& b, int world, BodyId body) {
  return position(b, world, row_of(b, world, body));
}
inline Vec3 velocity(const Batch& b, int world, BodyId body) {
  return velocity(b, world, row_of(b, world, body));
}
inline Vec3 spin(const Batch& b, int world, BodyId body) {
  return spin(b, world, row_of(b, world, body));
}
inline Quat rotation(const Batch& b, int world, BodyId body) {
  return rotation(b, world, row_of(b, world, body));
}

// Puts one vector of one body of one world, leaving the others alone.
inline void set_vector(Batch& batch, Field field, int world, int body, const Vec3& value) {
  std::vector<double> v = values(batch, field, world);
  const int n = components(field, space_of(batch));
  for (int i = 0; i < n; ++i)
    v[static_cast<std::size_t>(body * n + i)] = n == 1 ? value.z() : value(i);
  batch.write(field, world, v);
}

// Every state field of one world in a row: equal exactly when the states are.
inline std::vector<double> state(const Batch& batch, int world) {
  std::vector<double> all;
  for (int f = 0; f < kFieldCount; ++f) {
    const auto v = values(batch, static_cast<Field>(f), world);
    all.insert(all.end(), v.begin(), v.end());
  }
  return all;
}

// Sums over the dynamic bodies of a world, from its state and the scene's mass properties.
struct Momenta {
  Vec3 linear = Vec3::Zero();   // kg m/s
  Vec3 angular = Vec3::Zero();  // kg m^2/s about the origin
};
Momenta momenta(const Batch& batch, int world);
// Kinetic energy by the same way, independent of Batch::energy.
double kinetic_energy(const Batch& batch, int world);
double max_speed(const Batch& batch, int world);
// Deepest penetration among contacts, m, at least 0.
double max_penetration(const Batch& batch, int world);

}  // namespace manyworlds::test
