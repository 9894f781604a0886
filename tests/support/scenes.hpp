// Short ways to describe bodies and scenes in tests, and to look at one world of a Batch.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"
#include "scenes/builders.hpp"
#include "scenes/world_state.hpp"

namespace manyworlds::test {

using scenes::angle_between;
using scenes::body_of;
using scenes::box_of;
using scenes::cube_of;
using scenes::ground;
using scenes::ground_of;
using scenes::hinge_axes;
using scenes::in_row;
using scenes::kPi;
using scenes::lump;
using scenes::position;
using scenes::rotation;
using scenes::round_of;
using scenes::row_of;
using scenes::shape_of;
using scenes::solid_box;
using scenes::space_of;
using scenes::spin;
using scenes::uniform_rod;
using scenes::up_of;
using scenes::values;
using scenes::vector_of;
using scenes::velocity;
using scenes::z_to_y;

inline constexpr Space kSpaces[] = {Space::planar, Space::spatial};

inline Scene empty_scene(Space space, double gravity = 10) {
  return scenes::empty_scene(space, gravity, "test");
}
// A cube of 1 m at the origin.
inline Scene one_crate(Space space, double gravity = 0) {
  Scene scene = empty_scene(space, gravity);
  scene.add(body_of(shape_of(cube_of(space, 0.5)), Vec3::Zero()));
  return scene;
}
// The shortest rotation from one direction to another. Eigen's FromTwoVectors takes seconds to
// compile in every file that calls it.
Quat rotation_to(const Vec3& from, const Vec3& to);
// A box `side` wide to every side and `height` high, both half extents, m.
Geometry slab_of(Space space, double side, double height);

// Puts one vector of one body of one world, leaving the others alone.
inline void set_vector(Batch& batch, Field field, int world, int body, const Vec3& value) {
  std::vector<double> v = values(batch, field, world);
  const int n = components(field, space_of(batch));
  for (int i = 0; i < n; ++i)
    v[static_cast<std::size_t>(body * n + i)] = n == 1 ? value.z() : value(i);
  batch.write(field, world, v);
}

// One field of all worlds.
inline std::vector<double> read_all(const Batch& batch, Field field) {
  std::vector<double> v(batch.size(field));
  batch.read(field, std::span<double>(v));
  return v;
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
