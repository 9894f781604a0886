// Vectors and rotations as JSON.
#pragma once

#include "manyworlds/shape.hpp"
#include "src/page/json.hpp"

namespace manyworlds::page {

inline Json numbers(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Json numbers(const Quat& q) {  // w x y z, unit
  const Quat unit = q.normalized();
  return {unit.w(), unit.x(), unit.y(), unit.z()};
}

}  // namespace manyworlds::page
