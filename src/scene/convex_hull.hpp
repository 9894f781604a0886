// The faces of convex hulls, by Qhull. Used inside src only.
#pragma once

#include <memory>
#include <vector>

#include "manyworlds/mesh.hpp"

namespace manyworlds::detail {

inline constexpr std::size_t kFewestHullVertices = 4;

struct HullFace {
  std::vector<int> outline;  // of vertices, counter-clockwise seen from outside
  Vec3 normal;               // unit, outward
  double offset;             // normal . p <= offset for all points of the hull, m
  double thickness;          // how far the hull reaches back from it, m
};
struct ConvexHull {
  std::vector<Vec3> vertices;  // the corners, in the order of the points
  std::vector<HullFace> faces;
  bool flat() const { return faces.empty(); }
};

// Of 4 or more finite points. Faces within a millionth of the extent of one plane are one face.
// The last hulls are remembered: checks, masses, plans and pictures require the same ones.
std::shared_ptr<const ConvexHull> convex_hull(const std::vector<Vec3>& points);

// Its surface as triangles.
TriangleMesh surface(const ConvexHull& hull);

}  // namespace manyworlds::detail
