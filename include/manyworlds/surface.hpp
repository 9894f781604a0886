// Surface: the triangles and lines that represent a geometry in pictures. The page in a browser,
// Python's plots and examples/picture use it.
#pragma once

#include <array>
#include <vector>

#include "manyworlds/plan.hpp"

namespace manyworlds {

struct SurfaceOptions {
  Space space = Space::spatial;  // space of a capsule, which exists in both
  int around = 24;               // segments of a full circle, 8 to 1024
  // Box in the shape frame to which unbounded shapes (planes, half-planes) are clipped, m.
  Vec3 low = Vec3::Constant(-10), high = Vec3::Constant(10);
};

// In the shape frame, lengths in m. Points of round shapes are on the shape. The surface deviates
// from a circle of radius r by at most r (1 - cos(pi / around)).
//
// In space, the triangles cover the surface, counter-clockwise seen from outside. Surfaces of
// bounded shapes are closed. Faces do not share points: a corner is repeated with the normal of
// each face. In the plane, the triangles cover the inside at z = 0, counter-clockwise. Segments and
// terrains have no triangles.
struct Surface {
  std::vector<Vec3> points = {};
  std::vector<Vec3> normals = {};                  // unit, outward, one per point; in the plane: z
  std::vector<std::array<int, 3>> triangles = {};  // indices of points
  // Flat faces, {first, count}: convex polygons of `count` consecutive points. Round surfaces and
  // height fields have none.
  std::vector<std::array<int, 2>> faces = {};
  // Polylines. The last point of a closed one equals its first. In space: the edges of flat faces.
  // In the plane: the outline, counter-clockwise; for ground, the line that bodies touch.
  std::vector<std::vector<Vec3>> lines = {};
  // Polylines that make the rotation of a round shape visible: a radius of a circle, the equator of
  // a ball.
  std::vector<std::vector<Vec3>> marks = {};
};

// Throws std::invalid_argument if an option is out of range, SceneError if validate() would reject
// the geometry.
Surface surface(const Geometry& geometry, const SurfaceOptions& options = {});

}  // namespace manyworlds
