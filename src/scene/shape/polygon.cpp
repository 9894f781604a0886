// Convex polygons, rounded or not.
#include <algorithm>
#include <cmath>
#include <limits>

#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker, detail::kPi;

// Smallest area relative to the squared extent: a thinner polygon has no usable inside.
constexpr double kMinArea = 1e-6;

// Precondition: vertices are distinct. sense is +1 for counter-clockwise, -1 for clockwise.
void check_corners(Checker& checker, const std::vector<Vec2>& vertices, double sense) {
  const std::size_t n = vertices.size();
  bool good = true;
  double winding = 0;  // rad, sum of the exterior angles
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 before = vertices[i] - vertices[(i + n - 1) % n];
    const Vec2 after = vertices[(i + 1) % n] - vertices[i];
    const double sine = sense * detail::cross(before, after) / (before.norm() * after.norm());
    winding += std::atan2(sense * detail::cross(before, after), before.dot(after));
    if (sine > detail::kMinCornerSine) continue;
    good = false;
    if (sine < -detail::kMinCornerSine) {
      checker.add(
          detail::element_name("vertices", i),
          "at " + detail::vector_text(vertices[i]) + " m bends inwards, polygons must be convex");
    } else {
      checker.add(detail::element_name("vertices", i),
                  "at " + detail::vector_text(vertices[i]) +
                      " m is on a line with its neighbours, must be a corner");
    }
  }
  // A star bends left at every vertex, but goes around twice.
  if (good && winding > 3 * kPi) {
    checker.add("vertices", "go around more than once, must be the outline of a convex polygon");
  }
}

void check_polygon(Checker& checker, const Polygon& polygon) {
  const std::vector<Vec2>& vertices = polygon.vertices;
  if (vertices.size() < 3 || vertices.size() > kernels::kMaxVertices) {
    checker.add("vertices", "are " + std::to_string(vertices.size()) + ", must be 3 to 8");
    return;
  }
  bool good = true;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    good &= detail::check_point(checker, detail::element_name("vertices", i), vertices[i]);
  }
  if (!good) return;

  double extent = 0;  // m, farthest vertex from vertex 0
  double area = 0;    // m^2, signed; about vertex 0, so that a far polygon loses no digits
  for (std::size_t i = 1; i < vertices.size(); ++i) {
    const Vec2 edge = vertices[i] - vertices[0];
    extent = std::max(extent, edge.norm());
    if (i + 1 < vertices.size()) area += 0.5 * detail::cross(edge, vertices[i + 1] - vertices[0]);
  }
  if (!detail::check_distinct(checker, vertices, extent)) return;
  const double smallest = std::max(kMinArea * extent * extent, detail::kMinSize * detail::kMinSize);
  if (std::abs(area) < smallest) {
    checker.add("vertices", "enclose " + detail::number_text(std::abs(area)) +
                                " m^2, must be at least " + detail::number_text(smallest));
    return;
  }
  if (area < 0) checker.add("vertices", "run clockwise, must be counter-clockwise");
  check_corners(checker, vertices, area < 0 ? -1 : 1);
}

// What a radius r adds to area, centre moment and polar moment about vertex 0: a rectangle along
// each edge of length l, with (l^2 + r^2) / 12 about its own centre, and at each corner a sector of
// the exterior angle a there, whose centre of mass is 4 r sin(a / 2) / (3 a) away
// from the corner and which has r^2 / 2 about it.
void add_rounding(const Polygon& polygon, double& area, Vec2& first, double& second) {
  const std::vector<Vec2>& v = polygon.vertices;
  const std::size_t n = v.size();
  const double r = polygon.radius;
  const auto way = [&](std::size_t i) { return Vec2(v[(i + 1) % n] - v[i % n]); };
  for (std::size_t i = 0; i < n; ++i) {
    const Vec2 corner = v[i] - v[0], edge = way(i), before = way(i + n - 1);
    const double length = edge.norm();
    const Vec2 normal = Vec2(edge.y(), -edge.x()) / length;
    const Vec2 middle = corner + edge / 2 + normal * (r / 2);
    area += length * r;
    first += length * r * middle;
    second += length * r * ((length * length + r * r) / 12 + middle.squaredNorm());

    const double angle =
        std::atan2(before.x() * edge.y() - before.y() * edge.x(), before.dot(edge));
    const double sector = angle * r * r / 2;
    const Vec2 out = (normal + Vec2(before.y(), -before.x()).normalized()).normalized();
    const Vec2 away = out * (4 * r * std::sin(angle / 2) / (3 * angle));
    area += sector;
    first += sector * (corner + away);
    // About the corner, shifted to vertex 0.
    second += sector * (r * r / 2 + corner.squaredNorm() + 2 * corner.dot(away));
  }
}

// A fan of triangles (0, a, b) from vertex 0, with twice the signed area D = a x b each:
//   area += D / 2,  centre moment += D (a + b) / 6,  polar moment += D (a.a + a.b + b.b) / 12.
MassProperties polygon_mass(const Polygon& polygon, double density) {
  const Vec2& origin = polygon.vertices.front();
  double area = 0;
  Vec2 first = Vec2::Zero();
  double second = 0;  // about vertex 0
  for (std::size_t i = 1; i + 1 < polygon.vertices.size(); ++i) {
    const Vec2 a = polygon.vertices[i] - origin;
    const Vec2 b = polygon.vertices[i + 1] - origin;
    const double twice_area = a.x() * b.y() - a.y() * b.x();
    area += twice_area / 2;
    first += twice_area / 6 * (a + b);
    second += twice_area / 12 * (a.dot(a) + a.dot(b) + b.dot(b));
  }
  if (polygon.radius > 0) add_rounding(polygon, area, first, second);
  const Vec2 offset = first / area;
  const Vec2 center = origin + offset;
  const double moment = density * (second - area * offset.squaredNorm());
  return {density * area, {center.x(), center.y(), 0}, detail::planar_inertia(moment)};
}

class PolygonTraits final : public TraitsOf<Polygon> {
 public:
  PolygonTraits() : TraitsOf({.name = "polygon", .in_plane = true}) {}

  int sizes() const override { return 2; }
  double size(const Geometry& g, int component) const override {
    return detail::half_extent(std::get<Polygon>(g).vertices, component);
  }
  void resize(Geometry& g, int component, double value) const override {
    detail::stretch(std::get<Polygon>(g).vertices, component, value);
  }

 protected:
  void examine(Checker& checker, const Polygon& polygon) const override {
    check_polygon(checker, polygon);
    if (polygon.radius != 0) checker.size("radius", polygon.radius);
  }
  MassProperties mass_of(const Polygon& polygon, double density, Space) const override {
    return polygon_mass(polygon, density);
  }
  std::vector<Convex> parts_of(const Polygon& polygon, const Vec3& x, const Mat3& r,
                               Space) const override {
    Convex c;
    for (const Vec2& v : polygon.vertices) c.points.push_back(x + r * detail::in_plane(v));
    const std::size_t n = c.points.size();
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t next = (i + 1) % n;
      c.edges.push_back({static_cast<int>(i), static_cast<int>(next)});
      const Vec3 along = (c.points[next] - c.points[i]).normalized();
      c.normals.push_back({along.y(), -along.x(), 0});
    }
    c.radius = polygon.radius;
    return {c};
  }
  ShapeForm form_of(const Polygon& polygon, const PolygonChoice& choice) const override {
    const auto& v = polygon.vertices;
    Vec2 middle = Vec2::Zero();
    for (const Vec2& p : v) middle += p / static_cast<double>(v.size());
    ShapeForm f;
    f.offset = detail::in_plane(middle);
    if (choice.rectangles) {
      f.kind = kernels::ShapeKind::rectangle;
      const Vec2 edge = v[1] - v[0];
      f.half = {edge.norm() / 2, (v[2] - v[1]).norm() / 2, 0};
      if (edge.y() != 0 || edge.x() < 0) {
        f.rotation =
            Eigen::AngleAxisd(std::atan2(edge.y(), edge.x()), Vec3::UnitZ()).toRotationMatrix();
      }
      f.radius = f.half.norm();
      f.inner_radius = std::min(f.half.x(), f.half.y());
      return f;
    }
    f.kind = choice.rounded ? kernels::ShapeKind::rounded : kernels::ShapeKind::polygon;
    f.thickness = polygon.radius;
    f.inner_radius = std::numeric_limits<double>::max();
    // Vertices about their own middle, so that rows hold small numbers.
    for (const Vec2& p : v) f.vertices.push_back(p - middle);
    for (std::size_t i = 0; i < v.size(); ++i) {
      const Vec2 edge = f.vertices[(i + 1) % v.size()] - f.vertices[i];
      const Vec2 normal = Vec2(edge.y(), -edge.x()).normalized();
      f.radius = std::max(f.radius, f.vertices[i].norm());
      f.inner_radius = std::min(f.inner_radius, normal.dot(f.vertices[i]));
    }
    f.radius += polygon.radius, f.inner_radius += polygon.radius;
    return f;
  }
  Surface surface_of(const Polygon& polygon, const SurfaceOptions& o) const override {
    std::vector<Vec3> outline;
    const std::size_t n = polygon.vertices.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Vec2& at = polygon.vertices[i];
      if (polygon.radius == 0) {
        outline.push_back(detail::in_plane(at));
        continue;
      }
      const Vec2 before = at - polygon.vertices[(i + n - 1) % n];
      const Vec2 after = polygon.vertices[(i + 1) % n] - at;
      const double from = std::atan2(-before.x(), before.y());
      const double turn = std::atan2(detail::cross(before, after), before.dot(after));
      detail::add_arc(outline, detail::in_plane(at), polygon.radius, from, from + turn, o.around);
    }
    return detail::planar_solid(outline);
  }
};

}  // namespace

MW_GEOMETRY(Polygon)

}  // namespace manyworlds
