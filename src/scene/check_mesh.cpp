// validate() of a triangle mesh. Problems come in thousands here, where one hole in a scan opens
// every edge around it: of each kind, the first few are listed and the rest counted.
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <tuple>
#include <vector>

#include "src/base/float_mode.hpp"
#include "src/scene/checks.hpp"
#include "src/scene/mesh_moments.hpp"

namespace manyworlds {
namespace {

using detail::Checker;
using detail::element_name;
using detail::number_text;

// Twice the area of a triangle relative to its longest edge squared: below it, nothing but rounding
// is left of its normal.
constexpr double kZeroArea = 1e-12;

// Problems of one kind.
class Kind {
 public:
  explicit Kind(Checker& checker) : checker_(&checker) {}

  // Counts one more, and tells whether it is to be listed.
  bool list() { return ++count_ <= kMaxListed; }
  bool none() const { return count_ == 0; }
  // The rest: "9990 more edges", "are used once".
  void finish(const std::string& plural, const std::string& message) const {
    if (count_ <= kMaxListed) return;
    checker_->add(std::to_string(count_ - kMaxListed) + " more " + plural, message);
  }

 private:
  static constexpr std::size_t kMaxListed = 10;

  Checker* checker_;
  std::size_t count_ = 0;
};

bool is_finite(const Vec3& vertex) {
  return (vertex.array().abs() <= detail::kLargestFinite).all();
}

void check_vertices(Checker& checker, const TriangleMesh& mesh) {
  Kind bad(checker);
  for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
    if (is_finite(mesh.vertices[i]) || !bad.list()) continue;
    checker.finite(element_name("vertices", i), mesh.vertices[i], "m");
  }
  bad.finish("vertices", "are not finite, must be finite");
}

bool check_indices(Checker& checker, const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.vertices.size();
  const std::string expected =
      ", must be >= 0 and < " + std::to_string(vertices) + ", the number of vertices";
  Kind bad(checker);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    for (std::size_t corner = 0; corner < 3; ++corner) {
      const int index = mesh.triangles[i][corner];
      if (index >= 0 && static_cast<std::size_t>(index) < vertices) continue;
      if (!bad.list()) continue;
      checker.add(element_name(element_name("triangles", i), corner),
                  "is " + std::to_string(index) + expected);
    }
  }
  bad.finish("indices", "are out of range" + expected);
  return bad.none();
}

// The vertex that a triangle has more than once, or -1.
int repeated_vertex(const std::array<int, 3>& triangle) {
  if (triangle[0] == triangle[1] || triangle[0] == triangle[2]) return triangle[0];
  return triangle[1] == triangle[2] ? triangle[1] : -1;
}

// Precondition of this and of what follows: all indices are valid.
void check_areas(Checker& checker, const TriangleMesh& mesh) {
  Kind repeated(checker);
  Kind flat(checker);
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    const std::array<int, 3>& triangle = mesh.triangles[i];
    if (const int vertex = repeated_vertex(triangle); vertex >= 0) {
      if (!repeated.list()) continue;
      checker.add(element_name("triangles", i),
                  "has vertex " + std::to_string(vertex) +
                      " more than once, must have three different ones");
      continue;
    }
    const auto [a, b, c] = detail::corners(mesh, triangle);
    if (!is_finite(a) || !is_finite(b) || !is_finite(c)) continue;
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double area = 0.5 * (b - a).cross(c - a).norm();
    if (2 * area > kZeroArea * longest * longest || !flat.list()) continue;
    checker.add(element_name("triangles", i), "has an area of " + number_text(area) +
                                                  " m^2 and an edge of " + number_text(longest) +
                                                  " m, must not be degenerate");
  }
  repeated.finish("triangles", "have a vertex more than once, must have three different ones");
  flat.finish("triangles", "have no area, must not be degenerate");
}

struct Edge {
  int low, high;  // vertices
  bool upward;    // whether a triangle runs from low to high
};

// Sorted, one for each side of each triangle. Triangles that have a vertex more than once are an
// issue of their own, and run along their edges once in each direction: the others close or not
// without them.
std::vector<Edge> sorted_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (const std::array<int, 3>& triangle : mesh.triangles) {
    if (repeated_vertex(triangle) >= 0) continue;
    for (std::size_t side = 0; side < 3; ++side) {
      const int from = triangle[side];
      const int to = triangle[(side + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), from < to});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high) < std::tie(b.low, b.high);
  });
  return edges;
}

void check_edges(Checker& checker, const TriangleMesh& mesh) {
  const std::string expected = ", must be used twice, in opposite directions";
  const std::string once = "used once" + expected + " (open)";
  const std::string same =
      "used twice in one direction" + expected + " (one of its triangles is wound the other way)";
  const std::string manifold = expected + " (not a manifold)";

  Kind open(checker);
  Kind flipped(checker);
  Kind crowded(checker);
  const std::vector<Edge> edges = sorted_edges(mesh);
  for (auto first = edges.begin(); first != edges.end();) {
    const auto last = std::find_if(first, edges.end(), [&](const Edge& edge) {
      return edge.low != first->low || edge.high != first->high;
    });
    const auto uses = last - first;
    const auto upward = std::count_if(first, last, [](const Edge& edge) { return edge.upward; });
    const std::string place =
        "edge " + std::to_string(first->low) + "-" + std::to_string(first->high);
    if (uses == 1) {
      if (open.list()) checker.add(place, "is " + once);
    } else if (uses > 2) {
      if (crowded.list()) {
        checker.add(place, "is used " + std::to_string(uses) + " times" + manifold);
      }
    } else if (upward != 1) {
      if (flipped.list()) checker.add(place, "is " + same);
    }
    first = last;
  }
  open.finish("edges", "are " + once);
  flipped.finish("edges", "are " + same);
  crowded.finish("edges", "are used more than twice" + manifold);
}

void check_volume(Checker& checker, const TriangleMesh& mesh) {
  const detail::MeshMoments moments = detail::mesh_moments(mesh, detail::mesh_middle(mesh));
  // The volume of a flat mesh is rounding, with either sign.
  if (std::abs(moments.volume) <= moments.rounding) {
    checker.add("volume", "is 0 m^3 up to rounding, must be > 0");
  } else if (moments.volume < 0) {
    checker.add("volume", "is " + number_text(moments.volume) +
                              " m^3, must be > 0 (the triangles run clockwise seen from outside)");
  }
}

}  // namespace

std::vector<Issue> validate(const TriangleMesh& mesh) {
  const FloatMode mode;
  std::vector<Issue> issues;
  Checker checker(issues, Space::spatial);
  check_vertices(checker, mesh);
  if (mesh.triangles.empty()) checker.add("triangles", "are missing, must enclose a volume");
  if (check_indices(checker, mesh)) {
    check_areas(checker, mesh);
    check_edges(checker, mesh);
  }
  if (issues.empty()) check_volume(checker, mesh);
  return issues;
}

}  // namespace manyworlds
