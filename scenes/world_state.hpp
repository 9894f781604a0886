// The state of one world of a Batch as vectors, for tests and reports.
#pragma once

#include <cmath>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::scenes {

// Values of one field of one world, as [item][component].
inline std::vector<double> values(const Batch& batch, Field field, int world = 0) {
  std::vector<double> v(batch.plan(batch.kind_of(world)).numbers(field));
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

// rad; neither has to be of length 1.
inline double angle_between(const Quat& a, const Quat& b) {
  const Quat d = a.conjugate() * b;
  return 2 * std::atan2(d.vec().norm(), std::abs(d.w()));
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

}  // namespace manyworlds::scenes
