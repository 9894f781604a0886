// Hulls as tables of corners and faces.
#include <algorithm>
#include <cmath>

#include "src/plan/hull_map.hpp"
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
Vec3 rounded(const Vec3& v) { return {rounded(v.x()), rounded(v.y()), rounded(v.z())}; }

// To ask all of so many corners takes as long as to ask a map.
constexpr std::size_t kFewCorners = 64;
// What rounding in float32 leaves undecided of a product of three terms up to 1, with room.
constexpr double kMapRounding = 4e-6;
// Of the products of unit normals with directions up to sqrt(3) long: the largest tie of
// feature_along() (kernels/collide), with room.
constexpr double kMapTie = 2e-3;

// The vertices of a face between which contacts are looked for, at most kMaxOutline: those go first
// without which it loses least.
std::vector<int> outline_for_contacts(const std::vector<Vec3>& corners, std::vector<int> outline) {
  const auto loss = [&](std::size_t i) {
    const auto at = [&](std::size_t k) {
      return corners[static_cast<std::size_t>(outline[k % outline.size()])];
    };
    const Vec3 v = at(i), before = at(i + outline.size() - 1), after = at(i + 1);
    return (v - before).cross(after - v).norm();
  };
  while (outline.size() > kernels::kMaxOutline) {
    std::size_t least = 0;
    for (std::size_t i = 1; i < outline.size(); ++i) {
      if (loss(i) < loss(least)) least = i;
    }
    outline.erase(outline.begin() + static_cast<std::ptrdiff_t>(least));
  }
  return outline;
}

}  // namespace

HullCorners hull_corners(const Hull& hull, bool stretched) {
  Eigen::AlignedBox3d box;
  for (const Vec3& v : hull.vertices) box.extend(v);
  HullCorners out;
  out.middle = box.center();
  out.half = box.sizes() / 2;
  // In units of half its extents, so that corners and faces do not depend on how it is stretched.
  std::vector<Vec3> points;
  for (const Vec3& v : hull.vertices) {
    points.push_back(rounded((v - out.middle).cwiseQuotient(out.half)));
  }
  const auto found = detail::convex_hull(points);
  const detail::ConvexHull& solid = *found;
  const std::vector<Vec3>& corners = solid.vertices;
  Vec3 mean = Vec3::Zero();
  for (const Vec3& u : corners) {
    const Vec3 v = u.cwiseProduct(out.half);
    out.radius = std::max(out.radius, v.norm());
    mean += v / static_cast<double>(corners.size());
  }
  std::vector<double>& rows = out.rows;
  rows = {static_cast<double>(corners.size()), static_cast<double>(solid.faces.size()), 0, 0};
  const auto put = [&](const Vec3& u) { rows.insert(rows.end(), {u.x(), u.y(), u.z(), 0}); };
  for (const Vec3& u : corners) put(u);
  for (std::size_t first = 0; first < corners.size(); first += kernels::kCornerBlock) {
    for (int c = 0; c < 3; ++c) {
      for (std::size_t i = first; i < first + kernels::kCornerBlock; ++i) {
        rows.push_back(corners[std::min(i, corners.size() - 1)][c]);
      }
    }
  }
  out.inner_radius = out.half_thickness = out.radius;
  std::vector<Vec3> normals;
  std::vector<std::vector<int>> outlines;
  int first = 0;
  for (const detail::HullFace& f : solid.faces) {
    outlines.push_back(outline_for_contacts(corners, f.outline));
    const int count = static_cast<int>(outlines.back().size());
    // As long as the largest is 1.
    const double scale = 1 / f.normal.cwiseAbs().maxCoeff();
    put(rounded(f.normal * scale));
    rows.back() = rounded(f.offset * scale);
    rows.insert(rows.end(), {static_cast<double>(first), static_cast<double>(count), 0, 0});
    first += count;
    // As it is in space.
    const Vec3 m = f.normal.cwiseQuotient(out.half);
    normals.push_back(m.normalized());
    const double reach = f.offset / m.norm();
    out.inner_radius = std::min(out.inner_radius, reach);
    out.half_thickness = std::min(out.half_thickness, reach - normals.back().dot(mean));
  }
  for (const std::vector<int>& outline : outlines) {
    for (const int i : outline) put(corners[static_cast<std::size_t>(i)]);
  }
  const auto put_map = [&](std::size_t number, const std::vector<Vec3>& points, double margin) {
    const std::vector<double> map = direction_map(points, margin);
    if (map.empty()) return;
    rows[number] = static_cast<double>(rows.size() / 4);
    rows.insert(rows.end(), map.begin(), map.end());
  };
  if (corners.size() > kFewCorners) {
    put_map(2, corners, kMapRounding);
    if (!stretched) put_map(3, normals, kMapTie);
  }
  return out;
}

int put_corners(PlanData& plan, const HullCorners& corners) {
  std::vector<double>& all = plan.hulls;
  for (const PlanCollider& c : plan.colliders) {
    if (c.kind != kernels::ShapeKind::hull) continue;
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
