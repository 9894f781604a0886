// Slow double-precision twins of the collision kernels: signed separation of two shapes in the
// world, by exhaustive search over their features instead of by the kernels' formulas.
//
// The signed separation of convex A and B is the largest over unit directions d of
//   s(d) = min over b in B of d.b - max over a in A of d.a,
// which is the distance of disjoint shapes and minus the penetration depth of overlapping ones.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds::test {

struct Pose {
  Vec3 position = Vec3::Zero();
  Quat rotation = Quat::Identity();  // need not be unit
};
Pose operator*(const Pose& outer, const Pose& inner);

// One shape placed in the world. Planar shapes lie in z = 0.
struct Solid {
  enum class Kind { round, box, polygon, half_space, capsule, cylinder, hull, ellipsoid };
  Kind kind = Kind::round;

  Vec3 center = Vec3::Zero();        // round, box; else mean of the vertices
  double radius = 0;                 // round, capsule, polygon: of its rounding
  Mat3 axes = Mat3::Identity();      // box: columns are the face normals
  Vec3 half_extents = Vec3::Zero();  // box; ellipsoid: its radii
  std::vector<Vec3> vertices;        // box, hull: all; polygon: counter-clockwise; capsule: 2 ends
  bool planar = false;               // polygon, capsule
  double disc = 0;                   // cylinder: its radius; vertices are the ends of its axis
  std::vector<std::pair<Vec3, Vec3>> sides;  // hull: a point of each face, its outward normal
  std::vector<std::pair<Vec3, Vec3>> rims;   // hull: its edges
  Vec3 normal = Vec3::Zero();                // half space: normal . p <= offset is solid
  double offset = 0;
};

Solid make_solid(const Shape& shape, const Pose& body, Space space = Space::spatial);

// m; negative when the shapes overlap. At most one of the two is a half space.
double separation(const Solid& a, const Solid& b);
// s(d) above, for a unit direction from A to B. A half space has extent only along its normal.
double separation_along(const Solid& a, const Solid& b, const Vec3& direction);
// m; of a point from the surface, negative inside.
double signed_distance(const Solid& solid, const Vec3& point);
// The unit normal from A to B where it is unique and follows from a closed form: one of the
// shapes is round or a half space. Empty otherwise and near the places where it is not unique.
std::optional<Vec3> exact_normal(const Solid& a, const Solid& b);

}  // namespace manyworlds::test
