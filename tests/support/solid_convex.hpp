// Parts of the slow twins for cylinders, hulls and ellipsoids.
#pragma once

#include "tests/support/solid.hpp"

namespace manyworlds::test {

double point_segment(const Vec3& p, const Vec3& a, const Vec3& b);

// Signed, of a point from the surface.
double distance_to_cylinder(const Solid& s, const Vec3& p);
double distance_to_hull(const Solid& s, const Vec3& p);
double distance_to_ellipsoid(const Solid& s, const Vec3& p);
// Fills in the sides and rims of a hull.
void add_features(Solid& s);

// Gradient of the signed distance at a point, where it is unique and `clear` from where it is not.
std::optional<Vec3> outward_of_cylinder(const Solid& s, const Vec3& p, double clear);
std::optional<Vec3> outward_of_hull(const Solid& s, const Vec3& p, double clear);
std::optional<Vec3> outward_of_ellipsoid(const Solid& s, const Vec3& p, double clear);

// Where no list of normals has the best one. `looks`: normals to begin with.
double searched_separation(Solid a, Solid b, std::vector<Vec3> looks);

}  // namespace manyworlds::test
