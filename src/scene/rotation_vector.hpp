// Rotations as three numbers, axis times angle, rad: what varies of them.
#pragma once

#include <Eigen/Geometry>

#include "manyworlds/shape.hpp"

namespace manyworlds {

// Of the shorter way, no longer than pi.
inline Eigen::Vector3d rotation_vector(const Quat& rotation) {
  const Eigen::AngleAxisd r(Eigen::Quaterniond(rotation.normalized()));
  return r.angle() * r.axis();
}
inline Quat rotation_of(const Eigen::Vector3d& vector) {
  const double angle = vector.norm();
  if (angle == 0) return Quat::Identity();
  return Quat(Eigen::AngleAxisd(angle, vector / angle));
}

}  // namespace manyworlds
