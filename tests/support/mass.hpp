// Bodies of shapes, and how mass properties are compared.
#pragma once

#include <catch2/catch.hpp>
#include <utility>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds::test {

inline Shape shape(Geometry geometry, const Vec3& position = Vec3::Zero(),
                   const Quat& rotation = Quat::Identity()) {
  Shape result;
  result.geometry = std::move(geometry);
  result.position = position;
  result.rotation = rotation;
  return result;
}
inline Body body_of(std::vector<Shape> shapes) {
  Body body;
  body.shapes = std::move(shapes);
  return body;
}
inline Quat rotation_of(double angle, const Vec3& axis) {
  return Quat(Eigen::AngleAxisd(angle, axis.normalized()));
}

// Relative to mass, size and largest moment. 1e-13: some hundred roundings of double precision.
inline void check_equal(const MassProperties& a, const MassProperties& b, double size = 1,
                        double tolerance = 1e-13) {
  CHECK(std::abs(a.mass - b.mass) <= tolerance * b.mass);
  CHECK((a.center - b.center).norm() <= tolerance * size);
  CHECK((a.inertia - b.inertia).norm() <= tolerance * b.inertia.norm());
}

}  // namespace manyworlds::test
