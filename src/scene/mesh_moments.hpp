// Volume and moments of the solid inside a triangle mesh. Used only inside src/scene.
#pragma once

#include "manyworlds/mesh.hpp"

namespace manyworlds::detail {

// Integrals over the solid, about the origin that was asked for.
struct MeshMoments {
  double volume = 0;           // m^3
  Vec3 first = Vec3::Zero();   // m^4, integral of x
  Mat3 second = Mat3::Zero();  // m^5, integral of x x^T
  // m^3: what the volume may be wrong by. A solid with an inside has far more volume than that.
  double rounding = 0;
};

// Precondition of all: indices are valid.
std::array<Vec3, 3> corners(const TriangleMesh& mesh, const std::array<int, 3>& triangle);
// An origin far from the mesh costs digits.
MeshMoments mesh_moments(const TriangleMesh& mesh, const Vec3& origin);
// Middle of the bounding box of the triangles, m; there must be some.
Vec3 mesh_middle(const TriangleMesh& mesh);

}  // namespace manyworlds::detail
