// TriangleMesh: a closed surface of triangles, and the mass properties of the solid inside it. Use
// it for bodies whose mass distribution differs from their collision shapes:
//   body.mass_properties = mass_properties(mesh, 2700);  // the mesh in the body frame, aluminium
//
// Everything here is in double precision.
#pragma once

#include <array>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// The surface of a solid. The vertices of a triangle are counter-clockwise seen from outside. Every
// edge belongs to two triangles with opposite directions. Vertices are equal if their indices are
// equal: two vertices at the same position do not close a surface.
//
// Separate components add up. A cavity is a surface inside another one with the opposite winding:
// its triangles are counter-clockwise seen from inside the cavity. Intersecting triangles are not
// detected: space that is enclosed twice counts twice.
struct TriangleMesh {
  std::vector<Vec3> vertices = {};                 // m, in mesh axes; some may be unused
  std::vector<std::array<int, 3>> triangles = {};  // indices into vertices
};

// All issues, each with its location; empty if the functions below will succeed. Lists the first 10
// issues of a type and counts the others:
//   vertices[7].y is nan m, must be finite
//   triangles[3][1] is 12, must be >= 0 and < 8, the number of vertices
//   triangles[3] has vertex 5 more than once, must have three different ones
//   triangles[4] has an area of 0 m^2 and an edge of 2 m, must not be degenerate
//   edge 2-6 is used once, must be used twice, in opposite directions (open)
//   9990 more edges are used once, must be used twice, in opposite directions (open)
//   volume is -8 m^3, must be > 0 (the triangles run clockwise seen from outside)
// Edges are checked if all indices are valid, the volume if there is no other issue.
std::vector<Issue> validate(const TriangleMesh& mesh);

// m^3. Throws SceneError (plan.hpp), with the issues of validate().
double volume(const TriangleMesh& mesh);

// Mass properties of the enclosed solid with uniform `density` in kg/m^3: the centre of mass, and
// the inertia about it, in mesh axes. Exact up to rounding. A mesh far from its origin loses no
// digits beyond those that its coordinates have lost. Throws SceneError (plan.hpp) with the issues
// of validate() and of the density.
//
// The sum of signed tetrahedra: Blow and Binstock, "How to find the inertia tensor (or other mass
// properties) of a 3D solid body represented by a triangle mesh", 2004; the moments of one
// tetrahedron are those of Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor
// in terms of its vertex coordinates", J. Math. Stat. 1(1).
MassProperties mass_properties(const TriangleMesh& mesh, double density);

}  // namespace manyworlds
