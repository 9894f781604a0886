// Checks of one shape: geometry, local pose, density, material.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "src/scene/checks.hpp"
#include "src/scene/convex_hull.hpp"

namespace manyworlds::detail {
namespace {

constexpr std::size_t kFewestVertices = 3;
constexpr std::size_t kMostVertices = 8;
// Closer than this, relative to the polygon's extent, two vertices are the same to float32.
constexpr double kSameVertex = 1e-6;
// Smallest sine of the turn at a vertex: below it, the normals of two edges cannot be told apart
// and contact features would flicker between them.
constexpr double kSmallestTurn = 1e-5;
// Smallest area relative to the squared extent: a thinner polygon has no usable inside.
constexpr double kSmallestArea = 1e-6;

double cross(const Vec2& a, const Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

std::string vertex_name(std::size_t i) { return element_name("vertices", i); }

// |value| <= kLargestSize; for offsets and coordinates, which may have any sign.
bool check_coordinate(Checker& checker, std::string_view field, double value) {
  if (std::abs(value) <= kLargestSize) return true;
  if (!std::isfinite(value)) return checker.finite(field, value, "m");
  checker.add(field, "is " + number_text(value) + " m, must be between " +
                         number_text(-kLargestSize) + " and " + number_text(kLargestSize));
  return false;
}

template <class Vec>
bool check_distinct(Checker& checker, const std::vector<Vec>& vertices, double extent) {
  bool good = true;
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if ((vertices[i] - vertices[j]).norm() > kSameVertex * extent) continue;
      checker.add(vertex_name(i), "is " + vector_text(vertices[i]) + " m, the same as " +
                                      vertex_name(j) + "; vertices must be distinct");
      good = false;
      break;
    }
  }
  return good;
}

// Precondition: vertices are distinct. sense is +1 for counter-clockwise, -1 for clockwise.
void check_corners(Checker& checker, const std::vector<Vec2>& vertices, double sense) {
  const std::size_t n = vertices.size();
  bool good = true;
  double turned = 0;  // rad, sum of the exterior angles
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 before = vertices[i] - vertices[(i + n - 1) % n];
    const Vec2 after = vertices[(i + 1) % n] - vertices[i];
    const double sine = sense * cross(before, after) / (before.norm() * after.norm());
    turned += std::atan2(sense * cross(before, after), before.dot(after));
    if (sine > kSmallestTurn) continue;
    good = false;
    if (sine < -kSmallestTurn) {
      checker.add(vertex_name(i),
                  "at " + vector_text(vertices[i]) + " m bends inwards, polygons must be convex");
    } else {
      checker.add(vertex_name(i), "at " + vector_text(vertices[i]) +
                                      " m is on a line with its neighbours, must be a corner");
    }
  }
  // A star turns left at every vertex, but goes around twice.
  if (good && turned > 3 * std::numbers::pi) {
    checker.add("vertices", "go around more than once, must be the outline of a convex polygon");
  }
}

void check_polygon(Checker& checker, const Polygon& polygon) {
  const std::vector<Vec2>& vertices = polygon.vertices;
  if (vertices.size() < kFewestVertices || vertices.size() > kMostVertices) {
    checker.add("vertices", "are " + std::to_string(vertices.size()) + ", must be 3 to 8");
    return;
  }
  bool good = true;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    good &= check_coordinate(checker, vertex_name(i) + ".x", vertices[i].x());
    good &= check_coordinate(checker, vertex_name(i) + ".y", vertices[i].y());
  }
  if (!good) return;

  double extent = 0;  // m, farthest vertex from vertex 0
  double area = 0;    // m^2, signed; about vertex 0, so that a far polygon loses no digits
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const Vec2 edge = vertices[i] - vertices[0];
    extent = std::max(extent, edge.norm());
    if (i + 1 < vertices.size()) area += 0.5 * cross(edge, vertices[i + 1] - vertices[0]);
  }
  if (!check_distinct(checker, vertices, extent)) return;
  const double smallest = std::max(kSmallestArea * extent * extent, kSmallestSize * kSmallestSize);
  if (std::abs(area) < smallest) {
    checker.add("vertices", "enclose " + number_text(std::abs(area)) + " m^2, must be at least " +
                                number_text(smallest));
    return;
  }
  if (area < 0) checker.add("vertices", "run clockwise, must be counter-clockwise");
  check_corners(checker, vertices, area < 0 ? -1 : 1);
}

bool check_point(Checker& checker, const std::string& field, const Vec2& point) {
  const bool good = check_coordinate(checker, field + ".x", point.x());
  return check_coordinate(checker, field + ".y", point.y()) && good;
}

void check_segment(Checker& checker, const Segment& segment) {
  const bool good = check_point(checker, "a", segment.a);
  if (!check_point(checker, "b", segment.b) || !good) return;
  if ((segment.b - segment.a).norm() >= kSmallestSize) return;
  checker.add("b", "is " + vector_text(segment.b) + " m, the same as a; must be apart from it");
}

void check_height_field(Checker& checker, const HeightField& field) {
  constexpr std::size_t kMostPoints = 1000000;
  const std::size_t n = field.heights.size();
  checker.size("cell.x", field.cell.x());
  checker.size("cell.y", field.cell.y());
  if (field.columns < 2) {
    checker.add("columns", "is " + std::to_string(field.columns) + ", must be at least 2");
  } else if (n % static_cast<std::size_t>(field.columns) != 0 || field.rows() < 2) {
    checker.add("heights", "are " + std::to_string(n) + ", must be two rows or more of " +
                               std::to_string(field.columns));
  }
  if (n > kMostPoints) {
    checker.add("heights",
                "are " + std::to_string(n) + ", must be at most " + std::to_string(kMostPoints));
    return;
  }
  for (std::size_t i = 0; i < n; ++i) {
    check_coordinate(checker, element_name("heights", i), field.heights[i]);
  }
}

void check_terrain(Checker& checker, const Terrain& terrain) {
  const std::vector<Vec2>& points = terrain.points;
  const std::size_t n = points.size(), fewest = terrain.loop ? 3 : 2;
  if (n < fewest) {
    checker.add("points", "are " + std::to_string(n) + ", must be at least " +
                              std::to_string(fewest) + (terrain.loop ? " in a loop" : ""));
    return;
  }
  const auto name = [](std::size_t i) { return "points[" + std::to_string(i) + "]"; };
  bool good = true;
  for (std::size_t i = 0; i < n; ++i) good &= check_point(checker, name(i), points[i]);
  if (!good) return;

  double extent = 0;  // m, farthest point from point 0
  for (const Vec2& p : points) extent = std::max(extent, (p - points[0]).norm());
  const double least = std::max(kSameVertex * extent, kSmallestSize);
  for (std::size_t i = terrain.loop ? 0 : 1; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    if ((points[i] - points[before]).norm() > least) continue;
    checker.add(name(i), "is " + vector_text(points[i]) + " m, the same as " + name(before) +
                             "; neighbours must be apart");
    good = false;
  }
  if (!good) return;
  // A spike without width has no outside.
  for (std::size_t i = terrain.loop ? 0 : 1; i + (terrain.loop ? 0 : 1) < n; ++i) {
    const Vec2 before = (points[i] - points[(i + n - 1) % n]).normalized();
    const Vec2 after = (points[(i + 1) % n] - points[i]).normalized();
    if (before.dot(after) > 0 || std::abs(cross(before, after)) > kSmallestTurn) continue;
    checker.add(name(i), "at " + vector_text(points[i]) + " m folds back, must turn by less");
  }
}

void check_normal_length(Checker& checker, double length) {
  if (std::abs(length - 1) <= kInputTolerance) return;
  checker.add("normal", "has length " + number_text(length) + ", must be 1 (within " +
                            number_text(kInputTolerance) + ")");
}

void check_hull(Checker& checker, const Hull& hull) {
  const std::vector<Vec3>& vertices = hull.vertices;
  if (vertices.size() < kFewestHullVertices || vertices.size() > kMostHullVertices) {
    checker.add("vertices", "are " + std::to_string(vertices.size()) + ", must be 4 to 64");
    return;
  }
  bool good = true;
  double extent = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    good &= check_coordinate(checker, vertex_name(i) + ".x", vertices[i].x());
    good &= check_coordinate(checker, vertex_name(i) + ".y", vertices[i].y());
    good &= check_coordinate(checker, vertex_name(i) + ".z", vertices[i].z());
    extent = std::max(extent, (vertices[i] - vertices[0]).norm());
  }
  if (!good || !check_distinct(checker, vertices, extent)) return;
  const ConvexHull solid = convex_hull(vertices);
  if (solid.flat()) {
    checker.add("vertices", "lie in a plane, must enclose a volume");
    return;
  }
  for (const HullFace& f : solid.faces) {
    double low = f.offset;
    for (const Vec3& v : vertices) low = std::min(low, f.normal.dot(v));
    if (f.offset - low >= kSmallestSize) continue;
    checker.add("vertices", "are " + number_text(f.offset - low) + " m thick, must be at least " +
                                number_text(kSmallestSize));
    return;
  }
}

struct GeometryCheck {
  Checker& checker;
  const Body& body;

  void operator()(const Sphere& sphere) const {
    in_space(Space::spatial, "sphere");
    checker.size("radius", sphere.radius);
  }
  void operator()(const Box& box) const {
    in_space(Space::spatial, "box");
    checker.size("half_extents.x", box.half_extents.x());
    checker.size("half_extents.y", box.half_extents.y());
    checker.size("half_extents.z", box.half_extents.z());
  }
  void operator()(const Plane& plane) const {
    in_space(Space::spatial, "plane");
    on_fixed_body("plane");
    bool good = checker.finite("normal.x", plane.normal.x(), "");
    good &= checker.finite("normal.y", plane.normal.y(), "");
    good &= checker.finite("normal.z", plane.normal.z(), "");
    if (good) check_normal_length(checker, plane.normal.norm());
    check_coordinate(checker, "offset", plane.offset);
  }
  void operator()(const Circle& circle) const {
    in_space(Space::planar, "circle");
    checker.size("radius", circle.radius);
  }
  void operator()(const Polygon& polygon) const {
    in_space(Space::planar, "polygon");
    check_polygon(checker, polygon);
    if (polygon.radius != 0) checker.size("radius", polygon.radius);
  }
  void operator()(const Capsule& capsule) const {
    checker.size("radius", capsule.radius);
    checker.size("half_length", capsule.half_length);
  }
  void operator()(const Cylinder& cylinder) const {
    in_space(Space::spatial, "cylinder");
    checker.size("radius", cylinder.radius);
    checker.size("half_length", cylinder.half_length);
  }
  void operator()(const Hull& hull) const {
    in_space(Space::spatial, "hull");
    check_hull(checker, hull);
  }
  void operator()(const Segment& segment) const {
    in_space(Space::planar, "segment");
    on_fixed_body("segment");
    check_segment(checker, segment);
  }
  void operator()(const Terrain& terrain) const {
    in_space(Space::planar, "terrain");
    on_fixed_body("terrain");
    check_terrain(checker, terrain);
  }
  void operator()(const HeightField& field) const {
    in_space(Space::spatial, "height field");
    on_fixed_body("height field");
    check_height_field(checker, field);
  }
  void operator()(const HalfPlane& plane) const {
    in_space(Space::planar, "half-plane");
    on_fixed_body("half-plane");
    bool good = checker.finite("normal.x", plane.normal.x(), "");
    good &= checker.finite("normal.y", plane.normal.y(), "");
    if (good) check_normal_length(checker, plane.normal.norm());
    check_coordinate(checker, "offset", plane.offset);
  }

 private:
  void in_space(Space space, const std::string& kind) const {
    if (space == checker.space()) return;
    checker.add(
        "geometry",
        "is a " + kind +
            (checker.planar()
                 ? ", a planar scene takes circle, polygon, capsule, half-plane, segment and "
                   "terrain"
                 : ", a spatial scene takes sphere, box, capsule, cylinder, hull, plane "
                   "and height field"));
  }
  void on_fixed_body(const std::string& kind) const {
    if (body.motion == Motion::fixed) return;
    checker.add("geometry", "is a " + kind + " on a body that can move, must be on a fixed body");
  }
};

}  // namespace

void check_shape(Checker checker, const Body& body, const Shape& shape) {
  std::visit(GeometryCheck{checker, body}, shape.geometry);

  constexpr std::array<const char*, 3> kPosition = {"position.x", "position.y", "position.z"};
  if (checker.finite("position", shape.position, "m")) {
    for (int axis = 0; axis < 3; ++axis) {
      check_coordinate(checker, kPosition[static_cast<std::size_t>(axis)], shape.position[axis]);
    }
  }
  checker.rotation("rotation", shape.rotation);
  if (shape.density) checker.density("density", *shape.density);
  checker.not_negative("material.friction", shape.material.friction, "");
  checker.between("material.restitution", shape.material.restitution, 0, 1);
}

}  // namespace manyworlds::detail
