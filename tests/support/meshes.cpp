#include "tests/support/meshes.hpp"

#include <cmath>
#include <map>
#include <numbers>
#include <utility>

namespace manyworlds::test {
namespace {

// Two triangles; a, b, c, d run counter-clockwise.
void add_quad(TriangleMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

TriangleMesh icosahedron(double radius) {
  const double g = std::numbers::phi;
  TriangleMesh mesh;
  mesh.vertices = {{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                   {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  for (Vec3& vertex : mesh.vertices) vertex *= radius / vertex.norm();
  mesh.triangles = {{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                    {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                    {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                    {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  return mesh;
}

}  // namespace

TriangleMesh box_mesh(const Vec3& half_extents) {
  TriangleMesh mesh;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    mesh.vertices.emplace_back(sign.cwiseProduct(half_extents));
  }
  add_quad(mesh, 0, 2, 3, 1);  // -z
  add_quad(mesh, 4, 5, 7, 6);  // +z
  add_quad(mesh, 0, 1, 5, 4);  // -y
  add_quad(mesh, 2, 6, 7, 3);  // +y
  add_quad(mesh, 0, 4, 6, 2);  // -x
  add_quad(mesh, 1, 3, 7, 5);  // +x
  return mesh;
}

TriangleMesh tetrahedron(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return {{a, b, c, d}, {{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}};
}

TriangleMesh icosphere(double radius, int cuts) {
  TriangleMesh mesh = icosahedron(radius);
  for (int cut = 0; cut < cuts; ++cut) {
    std::map<std::pair<int, int>, int> middles;
    const auto middle = [&](int i, int j) {
      const auto [at, is_new] =
          middles.try_emplace(std::minmax(i, j), static_cast<int>(mesh.vertices.size()));
      if (is_new) {
        const Vec3 sum =
            mesh.vertices[static_cast<std::size_t>(i)] + mesh.vertices[static_cast<std::size_t>(j)];
        mesh.vertices.emplace_back(radius * sum.normalized());
      }
      return at->second;
    };
    std::vector<std::array<int, 3>> triangles;
    for (const auto [a, b, c] : mesh.triangles) {
      const int ab = middle(a, b);
      const int bc = middle(b, c);
      const int ca = middle(c, a);
      triangles.insert(triangles.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = std::move(triangles);
  }
  return mesh;
}

TriangleMesh torus_mesh(double ring_radius, double tube_radius, int around, int across) {
  TriangleMesh mesh;
  for (int i = 0; i < around; ++i) {
    const double u = 2 * std::numbers::pi * i / around;
    for (int j = 0; j < across; ++j) {
      const double v = 2 * std::numbers::pi * j / across;
      const double distance = ring_radius + tube_radius * std::cos(v);
      mesh.vertices.emplace_back(distance * std::cos(u), distance * std::sin(u),
                                 tube_radius * std::sin(v));
      const auto vertex = [&](int ring, int step) {
        return ring % around * across + step % across;
      };
      add_quad(mesh, vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1));
    }
  }
  return mesh;
}

TriangleMesh prism(const std::vector<Vec2>& outline, double height) {
  TriangleMesh mesh;
  const int n = static_cast<int>(outline.size());
  for (const double z : {0.0, height}) {
    for (const Vec2& corner : outline) mesh.vertices.emplace_back(corner.x(), corner.y(), z);
  }
  for (int i = 0; i < n; ++i) {
    const int next = (i + 1) % n;
    add_quad(mesh, i, next, n + next, n + i);
    if (i == 0 || next == 0) continue;
    mesh.triangles.push_back({0, next, i});
    mesh.triangles.push_back({n, n + i, n + next});
  }
  return mesh;
}

TriangleMesh moved(TriangleMesh mesh, const Vec3& position, const Quat& rotation, double scale) {
  const Mat3 r = rotation.normalized().toRotationMatrix();
  for (Vec3& vertex : mesh.vertices) vertex = position + r * (scale * vertex);
  return mesh;
}

TriangleMesh inside_out(TriangleMesh mesh) {
  for (std::array<int, 3>& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
  return mesh;
}

TriangleMesh together(TriangleMesh first, const TriangleMesh& second) {
  const int offset = static_cast<int>(first.vertices.size());
  first.vertices.insert(first.vertices.end(), second.vertices.begin(), second.vertices.end());
  for (const auto [a, b, c] : second.triangles) {
    first.triangles.push_back({a + offset, b + offset, c + offset});
  }
  return first;
}

}  // namespace manyworlds::test
