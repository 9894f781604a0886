// Closed triangle meshes with known insides. Lengths in m; all are turned the right way out.
#pragma once

#include "manyworlds/mesh.hpp"

namespace manyworlds::test {

// Centred on the origin: 8 vertices, vertex i at the sign of each bit of i, and 12 triangles.
TriangleMesh box_mesh(const Vec3& half_extents);
// d is on the side from which a, b, c run clockwise.
TriangleMesh tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d);
// Inscribed: an icosahedron whose triangles are cut in four `cuts` times.
TriangleMesh icosphere(double radius, int cuts);
// About z: `around` rings of `across` vertices each, on the torus with these radii.
TriangleMesh torus_mesh(double ring_radius, double tube_radius, int around, int across);
// From z = 0 to height; the outline runs counter-clockwise and is star-shaped about its vertex 0.
TriangleMesh prism(const std::vector<Vec2>& outline, double height);

// Vertices at position + rotation * scale * v.
TriangleMesh moved(TriangleMesh mesh, const Vec3& position, const Quat& rotation = Quat::Identity(),
                   double scale = 1);
TriangleMesh inside_out(TriangleMesh mesh);
// Both, with the vertices of the second after those of the first.
TriangleMesh together(TriangleMesh first, const TriangleMesh& second);

}  // namespace manyworlds::test
