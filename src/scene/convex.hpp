// Convex parts of shapes and how they lie to each other, by closed forms over their features.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "manyworlds/query.hpp"

namespace manyworlds {

// All points no farther than the radius from the hull of `points`; or a half space.
struct Convex {
  std::vector<Vec3> points;               // m, world
  std::vector<std::array<int, 2>> edges;  // of points
  std::vector<Vec3> normals;              // unit: of faces, and more where they do no harm
  std::vector<Vec3> directions;           // unit: of edges, in space
  double radius = 0;                      // m
  bool solid = false;                     // points may lie inside: boxes and polygons
  Mat3 axes = Mat3::Identity();           // of a box
  Vec3 center = Vec3::Zero(), half = Vec3::Zero();
  bool half_space = false;
  double offset = 0;  // of a half space: normals[0] . p <= offset is solid
  // Each point stands for an ellipsoid of these radii along the axes, m: of a cylinder for a disc.
  Vec3 radii = Vec3::Zero();
  // Of a hull in space: the normals of its faces are all its normals; normals[i] . p <= reach[i].
  // widths[i]: how far it reaches along normals[i] from one end to the other.
  std::vector<double> reach, widths;

  // The point that lies farthest along n, without the radius.
  Vec3 support(const Vec3& n) const;
};

// Half the least and the largest width of a convex part, m, across its faces and along its axes.
// The least of a hull may be a little too large, since it can be between edges.
struct Widths {
  double least = std::numeric_limits<double>::infinity(), most = 0;
};
Widths half_widths(const Convex& part, Space space);

// All points within the radius of x, or of the segment between two points.
Convex ball_of(const Vec3& x, double radius, Space space);
Convex segment_of(const Vec3& from, const Vec3& to, double radius, Space space);
// normal . p <= offset in a frame that stands at x.
Convex half_space_of(const Vec3& normal, double offset, const Vec3& x, const Mat3& r);

// One part, of a terrain one for each of its segments.
std::vector<Convex> convex_parts(const Shape& shape, const Pose& pose, Space space);

// At most one of the two is a half space.
Separation separation(const Convex& a, const Convex& b);

}  // namespace manyworlds
