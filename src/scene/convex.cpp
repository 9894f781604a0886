#include "src/scene/convex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/scene/convex_hull.hpp"
#include "src/scene/convex_search.hpp"

namespace manyworlds {

namespace {

constexpr double kFar = std::numeric_limits<double>::max();
constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

Vec3 across(const Vec3& a) {  // any unit vector across a unit vector
  return a.unitOrthogonal();
}
Vec3 left_of(const Vec3& a) { return {-a.y(), a.x(), 0}; }

struct Nearest {
  double distance = kFar;
  Vec3 a = Vec3::Zero(), b = Vec3::Zero();
  void take(const Vec3& on_a, const Vec3& on_b) {
    const double d = (on_b - on_a).norm();
    if (d < distance) distance = d, a = on_a, b = on_b;
  }
};

Vec3 nearest_on_segment(const Vec3& p, const Vec3& from, const Vec3& to) {
  const Vec3 way = to - from;
  const double length2 = way.squaredNorm();
  if (length2 == 0) return from;
  return from + way * std::clamp((p - from).dot(way) / length2, 0.0, 1.0);
}

// Of the hull's points, to one that is not inside it.
Vec3 nearest_on_hull(const Convex& c, const Vec3& p) {
  if (c.half.x() > 0) {
    const Vec3 local = c.axes.transpose() * (p - c.center);
    return c.center + c.axes * local.cwiseMax(-c.half).cwiseMin(c.half);
  }
  Nearest best;
  // Over a face, it is the one whose plane is farthest below p.
  if (!c.reach.empty()) {
    std::size_t face = 0;
    const auto height = [&](std::size_t i, const Vec3& x) {
      return c.normals[i].dot(x) - c.reach[i];
    };
    for (std::size_t i = 1; i < c.reach.size(); ++i) {
      if (height(i, p) > height(face, p)) face = i;
    }
    const Vec3 foot = p - height(face, p) * c.normals[face];
    bool inside = true;
    for (std::size_t i = 0; i < c.reach.size(); ++i) inside &= i == face || height(i, foot) <= 0;
    if (inside) return foot;
  }
  for (const Vec3& q : c.points) best.take(q, p);
  for (const auto& e : c.edges) {
    best.take(nearest_on_segment(p, c.points[at(e[0])], c.points[at(e[1])]), p);
  }
  return best.a;
}

// Where the lines of two edges come nearest, when that is on both of them; ends are looked at as
// points of the hulls.
void take_crossing(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1, Nearest& best) {
  const Vec3 u = a1 - a0, v = b1 - b0, r = b0 - a0;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v);
  const double det = uu * vv - uv * uv;
  if (det <= 1e-14 * uu * vv) return;  // parallel
  const double s = (r.dot(u) * vv - r.dot(v) * uv) / det;
  const double t = (r.dot(u) * uv - r.dot(v) * uu) / det;
  if (s < 0 || s > 1 || t < 0 || t > 1) return;
  best.take(a0 + s * u, b0 + t * v);
}

// Of hulls that do not overlap by more than a touch.
Nearest nearest_features(const Convex& a, const Convex& b, const Vec3& shift_b) {
  Nearest best;
  for (const Vec3& p : a.points) best.take(p, nearest_on_hull(b, p - shift_b) + shift_b);
  for (const Vec3& p : b.points) best.take(nearest_on_hull(a, p + shift_b), p + shift_b);
  for (const auto& e : a.edges) {
    for (const auto& f : b.edges) {
      take_crossing(a.points[at(e[0])], a.points[at(e[1])], b.points[at(f[0])] + shift_b,
                    b.points[at(f[1])] + shift_b, best);
    }
  }
  return best;
}

// The direction along which the hulls are farthest apart, or overlap least, of all in which that
// can be: normals of faces, and across two edges.
struct Widest {
  double gap = -kFar;
  Vec3 normal = Vec3::UnitX();
};

Widest widest_gap(const Convex& a, const Convex& b) {
  Widest best;
  const auto look = [&](const Vec3& n) {
    double low_a = kFar, high_a = -kFar, low_b = kFar, high_b = -kFar;
    for (const Vec3& p : a.points)
      low_a = std::min(low_a, n.dot(p)), high_a = std::max(high_a, n.dot(p));
    for (const Vec3& p : b.points)
      low_b = std::min(low_b, n.dot(p)), high_b = std::max(high_b, n.dot(p));
    if (low_b - high_a > best.gap) best = {low_b - high_a, n};
    if (low_a - high_b > best.gap) best = {low_a - high_b, -n};
  };
  for (const Vec3& n : a.normals) look(n);
  for (const Vec3& n : b.normals) look(n);
  for (const Vec3& d : a.directions) {
    for (const Vec3& e : b.directions) {
      const Vec3 n = d.cross(e);
      if (n.squaredNorm() > 1e-14) look(n.normalized());
    }
  }
  return best;
}

Convex segment_of(const Vec3& from, const Vec3& to, double radius, Space space) {
  Convex c;
  c.points = {from, to};
  c.edges = {{0, 1}};
  c.radius = radius;
  const Vec3 way = (to - from).normalized();
  // Besides the sides: along it, for segments in one line.
  if (space == Space::planar) {
    c.normals = {left_of(way), way};
  } else {
    c.normals = {across(way), way.cross(across(way)), way};
    c.directions = {way};
  }
  return c;
}

Convex hull_of(const Hull& hull, const Vec3& x, const Mat3& r) {
  const detail::ConvexHull solid = detail::convex_hull(hull.vertices);
  Convex c;
  for (const Vec3& v : solid.vertices) c.points.push_back(x + r * v);
  for (const detail::HullFace& f : solid.faces) {
    c.normals.push_back(r * f.normal);
    c.reach.push_back(f.offset + c.normals.back().dot(x));
    for (std::size_t i = 0; i < f.outline.size(); ++i) {
      const int from = f.outline[i], to = f.outline[(i + 1) % f.outline.size()];
      if (from > to) continue;  // once from either face
      c.edges.push_back({from, to});
      c.directions.push_back((c.points[at(to)] - c.points[at(from)]).normalized());
    }
  }
  return c;
}

// What is below a triangle, counter-clockwise seen from above, down to a level.
Convex prism_of(const std::array<Vec3, 3>& top, double level, const Vec3& x, const Mat3& r) {
  Convex c;
  for (const bool lower : {false, true}) {
    for (const Vec3& p : top) c.points.push_back(x + r * Vec3(p.x(), p.y(), lower ? level : p.z()));
  }
  const auto point = [&](int i) { return c.points[static_cast<std::size_t>(i)]; };
  const auto face = [&](const Vec3& normal, const Vec3& on) {
    c.normals.push_back(normal.normalized());
    c.reach.push_back(c.normals.back().dot(on));
  };
  const auto edge = [&](int from, int to) {
    c.edges.push_back({from, to});
    c.directions.push_back((point(to) - point(from)).normalized());
  };
  face((point(1) - point(0)).cross(point(2) - point(0)), point(0));
  face(-r.col(2), point(3));
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3;
    face((point(next) - point(i)).cross(r.col(2)), point(i));
    edge(i, next), edge(3 + i, 3 + next), edge(i, 3 + i);
  }
  return c;
}

// What is below each triangle of a surface, as deep as the field is wide below its lowest point.
std::vector<Convex> prisms_of(const HeightField& field, const Vec3& x, const Mat3& r) {
  const int columns = field.columns - 1, rows = field.rows() - 1;
  const double wide = columns * field.cell.x(), deep = rows * field.cell.y();
  const double level =
      *std::min_element(field.heights.begin(), field.heights.end()) - std::hypot(wide, deep);
  const auto corner = [&](int i, int j) {
    const double z = field.heights[static_cast<std::size_t>(i + j * field.columns)];
    return Vec3(i * field.cell.x() - wide / 2, j * field.cell.y() - deep / 2, z);
  };
  std::vector<Convex> out;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      const Vec3 low = corner(i, j), high = corner(i + 1, j + 1);
      out.push_back(prism_of({low, corner(i + 1, j), high}, level, x, r));
      out.push_back(prism_of({low, high, corner(i, j + 1)}, level, x, r));
    }
  }
  return out;
}

Separation of_half_space(const Convex& plane, const Convex& b) {
  const Vec3& n = plane.normals[0];
  const Vec3 lowest = b.support(-n);
  Separation s;
  s.distance = n.dot(lowest) - plane.offset - b.radius;
  s.point_b = lowest - n * b.radius;
  s.point_a = s.point_b - n * s.distance;
  s.normal = n;
  return s;
}

Separation turned(const Separation& s) { return {s.distance, s.point_b, s.point_a, -s.normal}; }

}  // namespace

Vec3 Convex::support(const Vec3& n) const {
  Vec3 best = points[0];
  for (const Vec3& p : points) {
    if (n.dot(p) > n.dot(best)) best = p;
  }
  // In the disc's own axes, so that it stays in the disc however little n points out of the axis.
  const Vec2 out(n.dot(axes.col(0)), n.dot(axes.col(1)));
  if (disc == 0 || out.isZero(0)) return best;
  return best + axes.leftCols<2>() * (disc * out.normalized());
}

std::vector<Convex> convex_parts(const Shape& shape, const Pose& pose, Space space) {
  const Mat3 outer = pose.rotation.normalized().toRotationMatrix();
  const Mat3 r = outer * shape.rotation.normalized().toRotationMatrix();
  const Vec3 x = pose.position + outer * shape.position;
  const auto place = [&](const Vec2& p) { return Vec3(x + r * Vec3(p.x(), p.y(), 0)); };
  const auto half_space = [&](const Vec3& normal, double offset) {
    Convex c;
    c.half_space = true;
    c.normals = {(r * normal).normalized()};
    c.offset = offset + c.normals[0].dot(x);
    return c;
  };
  const auto ball = [&](double radius) {
    Convex c;
    c.points = {x};
    c.normals = {Vec3::UnitX(), Vec3::UnitY()};
    if (space == Space::spatial) c.normals.push_back(Vec3::UnitZ());
    c.radius = radius;
    return c;
  };
  if (const auto* s = std::get_if<Sphere>(&shape.geometry)) return {ball(s->radius)};
  if (const auto* s = std::get_if<Circle>(&shape.geometry)) return {ball(s->radius)};
  if (const auto* s = std::get_if<Plane>(&shape.geometry))
    return {half_space(s->normal, s->offset)};
  if (const auto* s = std::get_if<HalfPlane>(&shape.geometry)) {
    return {half_space({s->normal.x(), s->normal.y(), 0}, s->offset)};
  }
  if (const auto* s = std::get_if<Capsule>(&shape.geometry)) {
    const Vec3 end = r.col(space == Space::planar ? 1 : 2) * s->half_length;
    return {segment_of(x - end, x + end, s->radius, space)};
  }
  if (const auto* s = std::get_if<Segment>(&shape.geometry)) {
    return {segment_of(place(s->a), place(s->b), 0, space)};
  }
  if (const auto* s = std::get_if<Terrain>(&shape.geometry)) {
    std::vector<Convex> links;
    const std::size_t n = s->points.size();
    for (std::size_t i = 0; i + (s->loop ? 0 : 1) < n; ++i) {
      links.push_back(segment_of(place(s->points[i]), place(s->points[(i + 1) % n]), 0, space));
    }
    return links;
  }
  if (const auto* s = std::get_if<HeightField>(&shape.geometry)) return prisms_of(*s, x, r);
  if (const auto* s = std::get_if<Cylinder>(&shape.geometry)) {
    const Vec3 end = r.col(2) * s->half_length;
    Convex c = segment_of(x - end, x + end, 0, space);
    c.axes = r;
    c.disc = s->radius;
    return {c};
  }
  if (const auto* s = std::get_if<Hull>(&shape.geometry)) return {hull_of(*s, x, r)};
  Convex c;
  if (const auto* s = std::get_if<Box>(&shape.geometry)) {
    c.axes = r, c.center = x, c.half = s->half_extents;
    for (int i = 0; i < 8; ++i) {
      const Vec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
      c.points.push_back(x + r * sign.cwiseProduct(c.half));
      for (const int bit : {1, 2, 4}) {
        if (!(i & bit)) c.edges.push_back({i, i | bit});
      }
    }
    for (int k = 0; k < 3; ++k) c.normals.push_back(r.col(k));
    c.directions = c.normals;
    return {c};
  }
  for (const Vec2& v : std::get<Polygon>(shape.geometry).vertices) c.points.push_back(place(v));
  const int n = static_cast<int>(c.points.size());
  for (int i = 0; i < n; ++i) {
    c.edges.push_back({i, (i + 1) % n});
    c.normals.push_back(-left_of((c.points[at((i + 1) % n)] - c.points[at(i)]).normalized()));
  }
  c.radius = std::get<Polygon>(shape.geometry).radius;
  return {c};
}

Separation separation(const Convex& a, const Convex& b) {
  if (a.half_space) return of_half_space(a, b);
  if (b.half_space) return turned(of_half_space(b, a));
  if (a.disc > 0 || b.disc > 0) return search_separation(a, b);
  const Widest widest = widest_gap(a, b);
  // Hulls that overlap: as they are when shifted until they touch.
  const double overlap = std::min(widest.gap, 0.0);
  const Vec3 shift = -overlap * widest.normal;
  const Nearest near = nearest_features(a, b, shift);
  double distance = overlap;
  Vec3 normal = widest.normal;
  if (widest.gap > 0) {
    distance = near.distance;
    if (near.distance > 1e-300) normal = (near.b - near.a) / near.distance;
  }
  Separation s;
  s.distance = distance - a.radius - b.radius;
  s.normal = normal;
  s.point_a = near.a + normal * a.radius;
  s.point_b = s.point_a + normal * s.distance;
  return s;
}

}  // namespace manyworlds
