// Surface: what a geometry looks like, as triangles and lines. Pictures of every kind are drawn
// from it: the page in a browser, Python's plots, examples/picture.
#pragma once

#include <array>
#include <vector>

#include "manyworlds/plan.hpp"

namespace manyworlds {

struct SurfaceOptions {
  Space space = Space::spatial;  // of a capsule, which both spaces have
  int around = 24;               // corners that stand for a full circle, 8 to 1024
  // Where shapes without end (planes, half-planes) are cut off: a box in the shape frame, m.
  Vec3 low = Vec3::Constant(-10), high = Vec3::Constant(10);
};

// In the shape frame, lengths in m. Round shapes are inscribed: their points lie on the shape, and
// of a circle of radius r no more than r (1 - cos(pi / around)) is missing anywhere.
//
// In space: triangles of the whole surface, counter-clockwise seen from outside. Bodies with an end
// are closed, though points of different faces differ in their normals alone and are listed twice.
// In the plane: triangles of the inside at z = 0, counter-clockwise; segments and terrains have
// none.
struct Surface {
  std::vector<Vec3> points = {};
  std::vector<Vec3> normals = {};                  // unit, outward, one per point; planar: z
  std::vector<std::array<int, 3>> triangles = {};  // of points
  // Flat faces, {first, count}: convex polygons of so many consecutive points. Of round surfaces
  // and height fields none.
  std::vector<std::array<int, 2>> faces = {};
  // Chains of points; closed ones end where they begin. In space the edges between flat faces and
  // what bounds them, in the plane the outline, counter-clockwise, of ground the line that bodies
  // touch.
  std::vector<std::vector<Vec3>> lines = {};
  // More chains, which show how a round shape turns: the radius of a circle, a ball's equator.
  std::vector<std::vector<Vec3>> marks = {};
};

// Throws std::invalid_argument for options that are out of range, SceneError for a geometry that
// validate() would not accept.
Surface surface(const Geometry& geometry, const SurfaceOptions& options = {});

}  // namespace manyworlds
