// Mass properties of closed triangle meshes: the sum over the tetrahedra (o, a, b, c) from an
// origin o to each triangle, signed by the side of the triangle that o is on. With a, b, c relative
// to o, D = a . (b x c) and s = a + b + c (Blow and Binstock, Tonon: see mesh.hpp):
//   volume = D / 6,  integral of x = D / 24 s,
//   integral of x x^T = D / 120 (s s^T + a a^T + b b^T + c c^T),
//   inertia = trace(X) 1 - X,  X = density * integral of x x^T.
#include <Eigen/Geometry>
#include <utility>

#include "manyworlds/plan.hpp"
#include "src/base/float_mode.hpp"
#include "src/scene/checks.hpp"
#include "src/scene/mesh_moments.hpp"

namespace manyworlds {
namespace detail {

std::array<Vec3, 3> corners(const TriangleMesh& mesh, const std::array<int, 3>& triangle) {
  const auto vertex = [&](int i) -> const Vec3& {
    return mesh.vertices[static_cast<std::size_t>(i)];
  };
  return {vertex(triangle[0]), vertex(triangle[1]), vertex(triangle[2])};
}

MeshMoments mesh_moments(const TriangleMesh& mesh, const Vec3& origin) {
  // Rounding of D, relative to |a| |b| |c|; some eight roundings of double precision.
  constexpr double kRounding = 1e-15;

  MeshMoments total;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    auto [a, b, c] = corners(mesh, triangle);
    a -= origin;
    b -= origin;
    c -= origin;
    const Vec3 s = a + b + c;
    const double d = a.dot(b.cross(c));
    total.volume += d;
    total.first += d * s;
    total.second +=
        d * (s * s.transpose() + a * a.transpose() + b * b.transpose() + c * c.transpose());
    total.rounding += kRounding * a.norm() * b.norm() * c.norm();
  }
  total.volume /= 6;
  total.first /= 24;
  total.second /= 120;
  total.rounding /= 6;
  return total;
}

Vec3 mesh_middle(const TriangleMesh& mesh) {
  Eigen::AlignedBox3d box;
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    for (const Vec3& corner : corners(mesh, triangle)) box.extend(corner);
  }
  return box.center();
}

}  // namespace detail

double volume(const TriangleMesh& mesh) {
  const FloatMode mode;
  std::vector<Issue> issues = validate(mesh);
  if (!issues.empty()) throw SceneError("mesh", std::move(issues));
  return FloatMode::done(detail::mesh_moments(mesh, detail::mesh_middle(mesh)).volume);
}

MassProperties mass_properties(const TriangleMesh& mesh, double density) {
  const FloatMode mode;
  std::vector<Issue> issues = validate(mesh);
  detail::Checker(issues, Space::spatial).density("density", density);
  if (!issues.empty()) throw SceneError("mesh", std::move(issues));

  // The centre is found first and the inertia summed about it, as for bodies made of shapes.
  const Vec3 middle = detail::mesh_middle(mesh);
  const detail::MeshMoments about_middle = detail::mesh_moments(mesh, middle);
  const Vec3 center = middle + about_middle.first / about_middle.volume;
  const detail::MeshMoments about_center = detail::mesh_moments(mesh, center);
  const Mat3 spread = density * about_center.second;
  return {density * about_middle.volume, center, spread.trace() * Mat3::Identity() - spread};
}

}  // namespace manyworlds
