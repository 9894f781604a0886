// Pieces that surfaces of geometries are put together from. Used inside src/scene only.
#pragma once

#include <vector>

#include "manyworlds/surface.hpp"

namespace manyworlds::detail {

// Appends a flat face: a convex polygon, counter-clockwise seen from where its normal points.
void add_face(Surface& surface, const std::vector<Vec3>& corners, const Vec3& normal);

// One ring of a surface of revolution about z.
struct Ring {
  double radius, height;  // m; radius 0: a pole
  double out, up;         // of the normal, away from the axis and along it
};
// Appends the surface between rings, from the lowest to the highest.
void add_revolved(Surface& surface, const std::vector<Ring>& rings, int around);

// A ball about the origin, with its equator as a mark.
Surface ball(double radius, int around);

// Points of a circle about z, counter-clockwise from x.
std::vector<Vec3> circle(double radius, double height, int around);
// The same, closed.
std::vector<Vec3> closed(std::vector<Vec3> line);

// A planar solid: its inside and outline, counter-clockwise.
Surface planar_solid(const std::vector<Vec3>& outline);
// Appends the arc around `center` between two angles, rad, ends included, in steps of no more than
// a full circle / around.
void add_arc(std::vector<Vec3>& outline, const Vec3& center, double radius, double from, double to,
             int around);

// What of a polygon lies where normal . p <= offset.
std::vector<Vec3> clipped(const std::vector<Vec3>& polygon, const Vec3& normal, double offset);

}  // namespace manyworlds::detail
