#include "src/scene/convex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/scene/convex_search.hpp"
#include "src/scene/shape/shape.hpp"

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

// How far its points lie from its first one, m.
double reach_of(const Convex& c) {
  double out = 0;
  for (const Vec3& p : c.points) out = std::max(out, (p - c.points[0]).cwiseAbs().maxCoeff());
  return out;
}

Separation swapped(const Separation& s) { return {s.distance, s.point_b, s.point_a, -s.normal}; }

}  // namespace

Vec3 Convex::support(const Vec3& n) const {
  Vec3 best = points[0];
  double most = n.dot(best);
  for (const Vec3& p : points) {
    const double along = n.dot(p);
    if (along > most) most = along, best = p;
  }
  // In its own axes, so that it stays in a disc however little n points out of the disc's axis.
  const Vec3 along = (axes.transpose() * n).cwiseProduct(radii);
  const double length = along.norm();
  if (length == 0) return best;
  return best + axes * along.cwiseProduct(radii) / length;
}

Widths half_widths(const Convex& part, Space space) {
  Widths out;
  const auto take = [&](double width) {
    const double half = width / 2 + part.radius;
    out.least = std::min(out.least, half), out.most = std::max(out.most, half);
  };
  const auto across = [&](const Vec3& n) { take(n.dot(part.support(n) - part.support(-n))); };
  if (part.widths.empty()) {
    for (const Vec3& n : part.normals) across(n);
  }
  for (const double width : part.widths) take(width);
  for (int i = 0; i < (space == Space::planar ? 2 : 3); ++i) across(part.axes.col(i));
  return out;
}

Convex ball_of(const Vec3& x, double radius, Space space) {
  Convex c;
  c.points = {x};
  c.normals = {Vec3::UnitX(), Vec3::UnitY()};
  if (space == Space::spatial) c.normals.push_back(Vec3::UnitZ());
  c.radius = radius;
  return c;
}

Convex half_space_of(const Vec3& normal, double offset, const Vec3& x, const Mat3& r) {
  Convex c;
  c.half_space = true;
  c.normals = {(r * normal).normalized()};
  c.offset = offset + c.normals[0].dot(x);
  return c;
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

std::vector<Convex> convex_parts(const Shape& shape, const Pose& pose, Space space) {
  const Mat3 outer = pose.rotation.normalized().toRotationMatrix();
  const Mat3 r = outer * shape.rotation.normalized().toRotationMatrix();
  const Vec3 x = pose.position + outer * shape.position;
  return traits_of(shape.geometry).convex_parts(shape.geometry, x, r, space);
}

Separation separation(const Convex& a, const Convex& b) {
  if (a.half_space) return of_half_space(a, b);
  if (b.half_space) return swapped(of_half_space(b, a));
  if (!a.radii.isZero(0) || !b.radii.isZero(0) || !few_crossings(a, b)) {
    return search_separation(a, b);
  }
  const Widest widest = widest_gap(a, b);
  // Hulls that overlap: as they are when shifted until they touch.
  const double overlap = std::min(widest.gap, 0.0);
  const Vec3 shift = -overlap * widest.normal;
  const Nearest near = nearest_features(a, b, shift);
  double distance = overlap;
  Vec3 normal = widest.normal;
  if (widest.gap > 0) {
    distance = near.distance;
    // The way between points that touch is no more than rounding.
    const double rounding = 1e-12 * std::max(near.a.cwiseAbs().maxCoeff(), reach_of(a));
    if (near.distance > rounding) normal = (near.b - near.a) / near.distance;
  }
  Separation s;
  s.distance = distance - a.radius - b.radius;
  s.normal = normal;
  s.point_a = near.a + normal * a.radius;
  s.point_b = s.point_a + normal * s.distance;
  return s;
}

}  // namespace manyworlds
