// Hulls as tables of corners and faces.
#include <algorithm>
#include <cmath>

#include "src/plan/plan_data.hpp"
#include "src/scene/convex_hull.hpp"

namespace manyworlds {

namespace {

// What stretching a hull leaves of these numbers but for rounding it leaves alone: a world whose
// hulls are stretched shares them with the others.
double rounded(double x) {
  constexpr double kGrid = 17179869184.0;  // 2^34
  return std::nearbyint(x * kGrid) / kGrid;
}

}  // namespace

HullCorners hull_corners(const Hull& hull) {
  const detail::ConvexHull solid = detail::convex_hull(hull.vertices);
  Eigen::AlignedBox3d box;
  for (const Vec3& v : solid.vertices) box.extend(v);
  HullCorners out;
  out.middle = box.center();
  out.half = box.sizes() / 2;
  out.vertices = static_cast<int>(solid.vertices.size());
  out.faces = static_cast<int>(solid.faces.size());
  const auto put = [&](const Vec3& v) {
    const Vec3 u = (v - out.middle).cwiseQuotient(out.half);
    out.rows.insert(out.rows.end(), {rounded(u.x()), rounded(u.y()), rounded(u.z()), 0});
  };
  for (const Vec3& v : solid.vertices) {
    put(v);
    out.radius = std::max(out.radius, (v - out.middle).norm());
  }
  out.inner_radius = out.half_thickness = out.radius;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& v : solid.vertices) mean += v / static_cast<double>(solid.vertices.size());
  int first = 0;
  for (const detail::HullFace& f : solid.faces) {
    const Vec3 m = f.normal.cwiseProduct(out.half);
    const double reach = f.offset - f.normal.dot(out.middle);
    const int count = static_cast<int>(f.outline.size());
    // As long as the largest is 1.
    const double scale = 1 / m.cwiseAbs().maxCoeff();
    out.rows.insert(out.rows.end(), {rounded(m.x() * scale), rounded(m.y() * scale),
                                     rounded(m.z() * scale), rounded(reach * scale),
                                     static_cast<double>(first), static_cast<double>(count), 0, 0});
    first += count;
    out.inner_radius = std::min(out.inner_radius, reach);
    out.half_thickness = std::min(out.half_thickness, f.offset - f.normal.dot(mean));
  }
  for (const detail::HullFace& f : solid.faces) {
    for (const int i : f.outline) put(solid.vertices[static_cast<std::size_t>(i)]);
  }
  return out;
}

int put_corners(PlanData& plan, const HullCorners& corners) {
  std::vector<double>& all = plan.hulls;
  for (const PlanCollider& c : plan.colliders) {
    if (c.kind != kernels::ShapeKind::hull || c.hull_vertices != corners.vertices ||
        c.hull_faces != corners.faces)
      continue;
    const std::size_t at = 4 * static_cast<std::size_t>(c.hull);
    if (all.size() - at < corners.rows.size()) continue;
    const auto there = all.begin() + static_cast<std::ptrdiff_t>(at);
    if (std::equal(corners.rows.begin(), corners.rows.end(), there)) return c.hull;
  }
  const int at = static_cast<int>(all.size() / 4);
  all.insert(all.end(), corners.rows.begin(), corners.rows.end());
  return at;
}

}  // namespace manyworlds
