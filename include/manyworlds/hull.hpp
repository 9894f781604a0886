// Convex hulls of clouds of points.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// The corners of the convex hull of the points, each of them one of the points; those that stick
// out of it by less than a millionth of its size are left out. m, in the frame of the points.
//
// Throws SceneError (plan.hpp) with every issue when there are fewer than 4 points, coordinates
// that are not finite, points all in one plane, or more than 64 corners:
//   hull: points[2].y is nan m, must be finite
//   hull: points lie in a plane, must enclose a volume
//   hull: vertices are 80, must be at most 64
Hull make_hull(const std::vector<Vec3>& points);

}  // namespace manyworlds
