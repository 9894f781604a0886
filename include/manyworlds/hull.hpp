// Convex hulls of point clouds.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

inline constexpr std::size_t kMaxHullVertices = 8192;  // of a Hull

// The convex hull of the points, in m, in their frame. Its corners are a subset of the points.
// Points that protrude by less than a millionth of the hull's size are omitted.
//
// Throws SceneError (plan.hpp), which lists all issues, if there are fewer than 4 points,
// coordinates that are not finite, coplanar points, or more than 8192 corners:
//   hull: points[2].y is nan m, must be finite
//   hull: points lie in a plane, must enclose a volume
//   hull: vertices are 9000, must be at most 8192
Hull make_hull(const std::vector<Vec3>& points);

}  // namespace manyworlds
