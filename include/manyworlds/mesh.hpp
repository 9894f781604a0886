// TriangleMesh: a closed surface of triangles, and the mass properties of the solid inside it. For
// bodies whose mass is spread differently from the shapes that they collide with:
//   body.mass_properties = mass_properties(mesh, 2700);  // the mesh in the body frame, aluminium
//
// Everything here is in double precision.
#pragma once

#include <array>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// The surface of a solid. The vertices of a triangle run counter-clockwise seen from outside; every
// edge belongs to two triangles, which run along it in opposite directions. Vertices are the same
// when their indices are: those that only lie in the same place do not close a surface.
//
// Parts that do not hang together add up. A cavity is a surface inside another one, wound the other
// way, so that its triangles run counter-clockwise seen from within the cavity. Triangles that pass
// through one another are not looked for: space that is enclosed twice counts twice.
struct TriangleMesh {
  std::vector<Vec3> vertices = {};                 // m, in mesh axes; a triangle need not use all
  std::vector<std::array<int, 3>> triangles = {};  // indices into vertices
};

// Everything that is wrong, at its place; empty means that the functions below will succeed. Of one
// kind of problem, the first 10 are listed and the rest counted:
//   vertices[7].y is nan m, must be finite
//   triangles[3][1] is 12, must be >= 0 and < 8, the number of vertices
//   triangles[3] has vertex 5 more than once, must have three different ones
//   triangles[4] has an area of 0 m^2 and an edge of 2 m, must not be degenerate
//   edge 2-6 is used once, must be used twice, in opposite directions (open)
//   9990 more edges are used once, must be used twice, in opposite directions (open)
//   volume is -8 m^3, must be > 0 (the triangles run clockwise seen from outside)
// Edges are judged when all indices are valid, the volume when there is no other issue.
std::vector<Issue> validate(const TriangleMesh& mesh);

// m^3. Throws SceneError (plan.hpp), with the issues of validate().
double volume(const TriangleMesh& mesh);

// Of the solid that the mesh encloses, filled evenly with `density` in kg/m^3: the centre of mass
// in mesh axes, the inertia about the centre of mass, also in mesh axes. Exact up to rounding,
// however far from its origin the mesh lies: no more digits are lost than its coordinates lost.
// Throws SceneError (plan.hpp), with the issues of validate() and that of the density.
//
// The sum of signed tetrahedra: Blow and Binstock, "How to find the inertia tensor (or other mass
// properties) of a 3D solid body represented by a triangle mesh", 2004; the moments of one
// tetrahedron are those of Tonon, "Explicit exact formulas for the 3-D tetrahedron inertia tensor
// in terms of its vertex coordinates", J. Math. Stat. 1(1).
MassProperties mass_properties(const TriangleMesh& mesh, double density);

}  // namespace manyworlds
