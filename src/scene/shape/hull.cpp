// Convex hulls.
#include <algorithm>
#include <cmath>

#include "manyworlds/hull.hpp"
#include "src/scene/convex_hull.hpp"
#include "src/scene/mesh_moments.hpp"
#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker;

class HullTraits final : public TraitsOf<Hull> {
 public:
  HullTraits() : TraitsOf({.name = "hull", .in_space = true}) {}

  int sizes() const override { return 3; }
  double size(const Geometry& g, int component) const override {
    return detail::half_extent(std::get<Hull>(g).vertices, component);
  }
  void resize(Geometry& g, int component, double value) const override {
    detail::stretch(std::get<Hull>(g).vertices, component, value);
  }

 protected:
  void examine(Checker& checker, const Hull& hull) const override {
    const std::vector<Vec3>& vertices = hull.vertices;
    if (vertices.size() < detail::kFewestHullVertices || vertices.size() > kMaxHullVertices) {
      checker.add("vertices", "are " + std::to_string(vertices.size()) + ", must be 4 to " +
                                  std::to_string(kMaxHullVertices));
      return;
    }
    bool good = true;
    double extent = 0;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      good &= detail::check_point(checker, detail::element_name("vertices", i), vertices[i]);
      extent = std::max(extent, (vertices[i] - vertices[0]).norm());
    }
    if (!good || !detail::check_distinct(checker, vertices, extent)) return;
    const auto solid = detail::convex_hull(vertices);
    if (solid->flat()) {
      checker.add("vertices", "lie in a plane, must enclose a volume");
      return;
    }
    for (const detail::HullFace& f : solid->faces) {
      if (f.thickness >= detail::kMinSize) continue;
      checker.add("vertices", "are " + detail::number_text(f.thickness) +
                                  " m thick, must be at least " +
                                  detail::number_text(detail::kMinSize));
      return;
    }
  }
  MassProperties mass_of(const Hull& hull, double density, Space) const override {
    const TriangleMesh mesh = detail::surface(*detail::convex_hull(hull.vertices));
    const Vec3 middle = detail::mesh_middle(mesh);
    const detail::MeshMoments about_middle = detail::mesh_moments(mesh, middle);
    // The centre of a symmetric hull comes out of sums: what is only rounding is zero.
    Vec3 offset = about_middle.first / about_middle.volume;
    const double size = (mesh.vertices[0] - middle).norm();
    for (int c = 0; c < 3; ++c) {
      if (std::abs(offset[c]) <= 1e-14 * size) offset[c] = 0;
    }
    const Vec3 center = middle + offset;
    const detail::MeshMoments about_center = detail::mesh_moments(mesh, center);
    const Mat3 spread = density * about_center.second;
    return {density * about_middle.volume, center, spread.trace() * Mat3::Identity() - spread};
  }
  double reach_of(const Hull& hull) const override {
    double out = 0;
    for (const Vec3& v : hull.vertices) out = std::max(out, v.norm());
    return out;
  }
  std::vector<Convex> parts_of(const Hull& hull, const Vec3& x, const Mat3& r,
                               Space) const override {
    const auto solid = detail::convex_hull(hull.vertices);
    Convex c;
    const auto point = [&](int i) { return c.points[static_cast<std::size_t>(i)]; };
    for (const Vec3& v : solid->vertices) c.points.push_back(x + r * v);
    for (const detail::HullFace& f : solid->faces) {
      c.normals.push_back(r * f.normal);
      c.reach.push_back(f.offset + c.normals.back().dot(x));
      c.widths.push_back(f.thickness);
      for (std::size_t i = 0; i < f.outline.size(); ++i) {
        const int from = f.outline[i], to = f.outline[(i + 1) % f.outline.size()];
        if (from > to) continue;  // once from either face
        c.edges.push_back({from, to});
        c.directions.push_back((point(to) - point(from)).normalized());
      }
    }
    return {c};
  }
  // Its corners are the plan's (src/plan/hulls.cpp).
  ShapeForm form_of(const Hull&, const PolygonChoice&) const override {
    return {kernels::ShapeKind::hull};
  }
  Surface surface_of(const Hull& hull, const SurfaceOptions&) const override {
    const auto solid = detail::convex_hull(hull.vertices);
    const auto corner = [&](int i) { return solid->vertices[static_cast<std::size_t>(i)]; };
    Surface out;
    for (const detail::HullFace& f : solid->faces) {
      std::vector<Vec3> corners;
      for (std::size_t i = 0; i < f.outline.size(); ++i) {
        const int from = f.outline[i], to = f.outline[(i + 1) % f.outline.size()];
        corners.push_back(corner(from));
        if (from < to) out.lines.push_back({corner(from), corner(to)});
      }
      detail::add_face(out, corners, f.normal);
    }
    return out;
  }
};

}  // namespace

MW_GEOMETRY(Hull)

}  // namespace manyworlds
