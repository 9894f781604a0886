// Convex hulls by Qhull (Barber, Dobkin and Huhdanpaa, "The Quickhull algorithm for convex hulls",
// 1996), the only file that includes it. Qhull merges facets that are coplanar within what it is
// told; here a millionth of the extent, which is what float32 tells apart.
#include "src/scene/convex_hull.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <string>

#include "manyworlds/hull.hpp"
#include "manyworlds/plan.hpp"
#include "src/base/float_mode.hpp"
#include "src/base/remembered.hpp"
#include "src/scene/checks.hpp"

extern "C" {
#include <libqhull_r/qhull_ra.h>
}

namespace manyworlds {
namespace detail {
namespace {

constexpr double kCoplanar = 1e-6;  // of the extent: facets this near to one plane are merged
constexpr double kThinnest = 1e-5;  // of the extent: less is flat

struct Close {
  void operator()(std::FILE* file) const { std::fclose(file); }
};

double extent_of(const std::vector<Vec3>& points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  return box.diagonal().norm();
}

// Facets as indices of points, in order around, and their outward normals.
struct Facet {
  std::vector<int> outline;
  Vec3 normal;
};

std::vector<Facet> facets_of(const std::vector<Vec3>& points, double extent) {
  // About their middle, so that a hull far from its origin loses no digits.
  const Vec3 middle = points[0];
  std::vector<double> numbers;
  for (const Vec3& p : points) {
    for (int c = 0; c < 3; ++c) numbers.push_back((p[c] - middle[c]) / extent);
  }
  // Qhull complains to a file; what we say instead is in our own words.
  const std::unique_ptr<std::FILE, Close> silence(std::fopen("/dev/null", "w"));
  std::string command = "qhull Pp C-" + number_text(kCoplanar);
  qhT state;
  qh_zero(&state, silence.get());
  std::vector<Facet> out;
  if (qh_new_qhull(&state, 3, static_cast<int>(points.size()), numbers.data(), False,
                   command.data(), nullptr, silence.get()) == 0) {
    for (facetT* f = state.facet_list; f != nullptr && f->next != nullptr; f = f->next) {
      Facet facet;
      facet.normal = {f->normal[0], f->normal[1], f->normal[2]};
      setT* around = qh_facet3vertex(&state, f);
      for (void** at = &around->e[0].p; *at != nullptr; ++at) {
        facet.outline.push_back(qh_pointid(&state, static_cast<vertexT*>(*at)->point));
      }
      qh_settempfree(&state, &around);
      out.push_back(std::move(facet));
    }
  }
  qh_freeqhull(&state, qh_ALL);
  int chunks = 0, bytes = 0;
  qh_memfreeshort(&state, &chunks, &bytes);
  return out;
}

// Twice the area times the normal, of an outline that need not be flat (Newell).
Vec3 area_of(const std::vector<Vec3>& points, const std::vector<int>& outline) {
  Vec3 area = Vec3::Zero();
  const auto at = [&](std::size_t i) {
    return Vec3(points[static_cast<std::size_t>(outline[i % outline.size()])] -
                points[static_cast<std::size_t>(outline[0])]);
  };
  for (std::size_t i = 1; i + 1 < outline.size(); ++i) area += at(i).cross(at(i + 1));
  return area;
}

ConvexHull make_convex_hull(const std::vector<Vec3>& points) {
  ConvexHull out;
  const double extent = extent_of(points);
  if (!(extent > 0)) return out;
  std::map<int, int> corner;  // of points
  std::vector<Facet> facets = facets_of(points, extent);
  for (const Facet& f : facets) {
    for (const int i : f.outline) corner[i] = 0;
  }
  for (auto& [point, index] : corner) {
    index = static_cast<int>(out.vertices.size());
    out.vertices.push_back(points[static_cast<std::size_t>(point)]);
  }
  Eigen::Matrix<double, Eigen::Dynamic, 3> all(static_cast<Eigen::Index>(out.vertices.size()), 3);
  for (Eigen::Index i = 0; i < all.rows(); ++i) {
    all.row(i) = out.vertices[static_cast<std::size_t>(i)];
  }
  Eigen::VectorXd heights(all.rows());
  for (Facet& f : facets) {
    HullFace face;
    for (const int i : f.outline) face.outline.push_back(corner[i]);
    Vec3 area = area_of(out.vertices, face.outline);
    if (area.dot(f.normal) < 0) {
      std::reverse(face.outline.begin(), face.outline.end());
      area = -area;
    }
    if (face.outline.size() < 3 || area.isZero(0)) continue;
    face.normal = area.normalized();
    heights.noalias() = all * face.normal;
    face.offset = heights.maxCoeff();
    face.thickness = face.offset - heights.minCoeff();
    if (face.thickness < kThinnest * extent) return {};  // flat
    // Qhull's order depends on coordinates, ours on that of the points alone.
    std::vector<int>& around = face.outline;
    std::rotate(around.begin(), std::min_element(around.begin(), around.end()), around.end());
    out.faces.push_back(std::move(face));
  }
  std::sort(out.faces.begin(), out.faces.end(),
            [](const HullFace& a, const HullFace& b) { return a.outline < b.outline; });
  if (out.faces.size() < 4) out.faces.clear();
  return out;
}

}  // namespace

std::shared_ptr<const ConvexHull> convex_hull(const std::vector<Vec3>& points) {
  static Remembered<Vec3, ConvexHull> last(1 << 18);
  return last.get(points, [&] { return make_convex_hull(points); });
}

TriangleMesh surface(const ConvexHull& hull) {
  TriangleMesh mesh;
  mesh.vertices = hull.vertices;
  for (const HullFace& f : hull.faces) {
    for (std::size_t i = 1; i + 1 < f.outline.size(); ++i) {
      mesh.triangles.push_back({f.outline[0], f.outline[i], f.outline[i + 1]});
    }
  }
  return mesh;
}

}  // namespace detail

Hull make_hull(const std::vector<Vec3>& points) {
  const FloatMode mode;
  std::vector<Issue> issues;
  detail::Checker checker(issues, Space::spatial);
  if (points.size() < detail::kFewestHullVertices) {
    checker.add("points", "are " + std::to_string(points.size()) + ", must be at least 4");
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    checker.finite(detail::element_name("points", i), points[i], "m");
  }
  Hull out;
  if (issues.empty()) {
    const std::shared_ptr<const detail::ConvexHull> hull = detail::convex_hull(points);
    if (hull->flat()) {
      checker.add("points", "lie in a plane, must enclose a volume");
    } else if (hull->vertices.size() > kMaxHullVertices) {
      checker.add("vertices", "are " + std::to_string(hull->vertices.size()) +
                                  ", must be at most " + std::to_string(kMaxHullVertices));
    }
    out.vertices = hull->vertices;
  }
  if (!issues.empty()) throw SceneError("hull", std::move(issues));
  return out;
}

}  // namespace manyworlds
