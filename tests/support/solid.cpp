#include "tests/support/solid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "tests/support/solid_convex.hpp"

namespace manyworlds::test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Corner number i has the sign of bit k in coordinate k; edges join corners that differ in a bit.
Vec3 corner_sign(int i) { return {i & 1 ? 1.0 : -1.0, i & 2 ? 1.0 : -1.0, i & 4 ? 1.0 : -1.0}; }

std::vector<std::pair<Vec3, Vec3>> edges(const Solid& s) {
  if (s.kind == Solid::Kind::hull) return s.rims;
  std::vector<std::pair<Vec3, Vec3>> result;
  if (s.kind == Solid::Kind::polygon || s.kind == Solid::Kind::capsule) {
    const std::size_t n = s.vertices.size();  // a capsule's axis is an edge to either side
    for (std::size_t i = 0; i < n; ++i) result.emplace_back(s.vertices[i], s.vertices[(i + 1) % n]);
  } else {
    for (int i = 0; i < 8; ++i) {
      for (int bit = 1; bit < 8; bit *= 2) {
        if (i & bit) continue;
        result.emplace_back(s.vertices[static_cast<std::size_t>(i)],
                            s.vertices[static_cast<std::size_t>(i | bit)]);
      }
    }
  }
  return result;
}

// The distance of two segments is at an end of one of them, or at the common perpendicular.
double segment_segment(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1) {
  double best = std::min({point_segment(a0, b0, b1), point_segment(a1, b0, b1),
                          point_segment(b0, a0, a1), point_segment(b1, a0, a1)});
  const Vec3 u = a1 - a0, v = b1 - b0, w = b0 - a0;
  const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v);
  const double det = uu * vv - uv * uv;
  if (det > 1e-12 * uu * vv) {
    const double s = (w.dot(u) * vv - w.dot(v) * uv) / det;
    const double t = (w.dot(u) * uv - w.dot(v) * uu) / det;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
      best = std::min(best, (a0 + s * u - b0 - t * v).norm());
  }
  return best;
}

// Outward normals of a polygon's edges, in the plane.
std::vector<Vec3> edge_normals(const Solid& s) {
  std::vector<Vec3> result;
  for (const auto& [a, b] : edges(s)) {
    const Vec3 d = b - a;
    result.push_back(Vec3(d.y(), -d.x(), 0).normalized());
  }
  return result;
}

// Directions of the edges of a spatial solid.
std::vector<Vec3> directions(const Solid& s) {
  if (s.kind == Solid::Kind::capsule || s.kind == Solid::Kind::cylinder)
    return {(s.vertices[1] - s.vertices[0]).normalized()};
  if (s.kind == Solid::Kind::hull) {
    std::vector<Vec3> result;
    for (const auto& [a, b] : s.rims) result.push_back((b - a).normalized());
    return result;
  }
  return {s.axes.col(0), s.axes.col(1), s.axes.col(2)};
}

// Every normal that a facet of the Minkowski difference can have: the penetration depth of two
// overlapping polytopes is attained at one of them. Of capsules, the axes are looked at.
std::vector<Vec3> facet_normals(const Solid& a, const Solid& b) {
  std::vector<Vec3> result;
  if (a.planar) {
    for (const Vec3& n : edge_normals(a)) result.push_back(n);
    for (const Vec3& n : edge_normals(b)) result.push_back(-n);
    return result;
  }
  for (const Solid* s : {&a, &b}) {
    if (s->kind == Solid::Kind::capsule) continue;
    if (s->kind == Solid::Kind::hull) {
      for (const auto& [point, n] : s->sides) result.push_back(n);
      continue;
    }
    for (const Vec3& n : directions(*s)) result.push_back(n);
  }
  for (const Vec3& u : directions(a)) {
    for (const Vec3& v : directions(b)) {
      const Vec3 n = u.cross(v);
      if (n.norm() > 1e-7) result.push_back(n.normalized());
    }
  }
  const std::size_t count = result.size();
  for (std::size_t i = 0; i < count; ++i) result.push_back(-result[i]);
  return result;
}

// Capsules are their axes here; separation() takes off the radii.
double polytope_separation(Solid a, Solid b) {
  a.radius = b.radius = 0;
  double depth_axis = -kInfinity;
  for (const Vec3& n : facet_normals(a, b))
    depth_axis = std::max(depth_axis, separation_along(a, b, n));
  if (depth_axis <= 0) return depth_axis;
  double distance = kInfinity;
  for (const auto& [a0, a1] : edges(a))
    for (const auto& [b0, b1] : edges(b))
      distance = std::min(distance, segment_segment(a0, a1, b0, b1));
  for (const Vec3& p : a.vertices) distance = std::min(distance, signed_distance(b, p));
  for (const Vec3& p : b.vertices) distance = std::min(distance, signed_distance(a, p));
  return distance;
}

// Lowest and highest coordinate of a bounded solid along a unit direction.
std::pair<double, double> extent(const Solid& s, const Vec3& d) {
  if (s.kind == Solid::Kind::round) return {s.center.dot(d) - s.radius, s.center.dot(d) + s.radius};
  double low = kInfinity, high = -kInfinity;
  for (const Vec3& v : s.vertices) {
    low = std::min(low, v.dot(d));
    high = std::max(high, v.dot(d));
  }
  double rim = 0;
  if (s.kind == Solid::Kind::cylinder) {
    const Vec3 axis = s.axes.col(2);
    rim = s.disc * (d - axis * axis.dot(d)).norm();
  }
  if (s.kind == Solid::Kind::ellipsoid) {
    rim = (s.axes.transpose() * d).cwiseProduct(s.half_extents).norm();
  }
  return {low - s.radius - rim, high + s.radius + rim};
}

// Gradient of the signed distance at a point, when it is unique by a clear margin.
std::optional<Vec3> outward(const Solid& s, const Vec3& p) {
  constexpr double kClear = 1e-3;
  switch (s.kind) {
    case Solid::Kind::half_space: return s.normal;
    case Solid::Kind::round: {
      const Vec3 d = p - s.center;
      if (d.norm() < kClear) return std::nullopt;
      return d.normalized();
    }
    case Solid::Kind::box: {
      const Vec3 local = s.axes.transpose() * (p - s.center);
      const Vec3 clamped = local.cwiseMax(-s.half_extents).cwiseMin(s.half_extents);
      if ((local - clamped).norm() > kClear) return s.axes * (local - clamped).normalized();
      if ((local - clamped).norm() > 0) return std::nullopt;
      const Vec3 inside = s.half_extents - local.cwiseAbs();
      int face = 0;
      inside.minCoeff(&face);
      for (int i = 0; i < 3; ++i)
        if (i != face && inside(i) < inside(face) + kClear) return std::nullopt;
      if (std::abs(local(face)) < kClear) return std::nullopt;
      return s.axes.col(face) * (local(face) > 0 ? 1.0 : -1.0);
    }
    case Solid::Kind::capsule: {
      const Vec3 along = s.vertices[1] - s.vertices[0];
      const double place = (p - s.vertices[0]).dot(along) / along.squaredNorm();
      const Vec3 d = p - s.vertices[0] - std::clamp(place, 0.0, 1.0) * along;
      if (d.norm() < kClear) return std::nullopt;
      return d.normalized();
    }
    case Solid::Kind::cylinder: return outward_of_cylinder(s, p, kClear);
    case Solid::Kind::hull: return outward_of_hull(s, p, kClear);
    case Solid::Kind::ellipsoid: return outward_of_ellipsoid(s, p, kClear);
    case Solid::Kind::polygon: {
      if (signed_distance(s, p) > -s.radius) {
        double best = kInfinity;
        Vec3 nearest = p;
        for (const auto& [a, b] : edges(s)) {
          const Vec3 d = b - a;
          const Vec3 q = a + std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d;
          if ((p - q).norm() < best) {
            best = (p - q).norm();
            nearest = q;
          }
        }
        if (best < kClear) return std::nullopt;
        return (p - nearest).normalized();
      }
      const auto sides = edges(s);
      const auto normals = edge_normals(s);
      std::size_t best = 0;
      std::vector<double> heights;
      for (std::size_t i = 0; i < sides.size(); ++i)
        heights.push_back(normals[i].dot(p - sides[i].first));
      for (std::size_t i = 0; i < sides.size(); ++i)
        if (heights[i] > heights[best]) best = i;
      for (std::size_t i = 0; i < sides.size(); ++i)
        if (i != best && heights[i] > heights[best] - kClear) return std::nullopt;
      return normals[best];
    }
  }
  return std::nullopt;
}

}  // namespace

Pose operator*(const Pose& outer, const Pose& inner) {
  const Quat q = outer.rotation.normalized();
  return {outer.position + q * inner.position, q * inner.rotation.normalized()};
}

Solid make_solid(const Shape& shape, const Pose& body, Space space) {
  const Pose pose = body * Pose{shape.position, shape.rotation};
  Solid s;
  s.center = pose.position;
  s.axes = pose.rotation.toRotationMatrix();
  if (const auto* sphere = std::get_if<Sphere>(&shape.geometry)) {
    s.radius = sphere->radius;
  } else if (const auto* circle = std::get_if<Circle>(&shape.geometry)) {
    s.radius = circle->radius;
  } else if (const auto* box = std::get_if<Box>(&shape.geometry)) {
    s.kind = Solid::Kind::box;
    s.half_extents = box->half_extents;
    for (int i = 0; i < 8; ++i)
      s.vertices.push_back(s.center + s.axes * corner_sign(i).cwiseProduct(s.half_extents));
  } else if (const auto* capsule = std::get_if<Capsule>(&shape.geometry)) {
    s.kind = Solid::Kind::capsule;
    s.planar = space == Space::planar;
    s.radius = capsule->radius;
    const Vec3 end = capsule->half_length * s.axes.col(s.planar ? 1 : 2);
    s.vertices = {s.center - end, s.center + end};
  } else if (const auto* cylinder = std::get_if<Cylinder>(&shape.geometry)) {
    s.kind = Solid::Kind::cylinder;
    s.disc = cylinder->radius;
    const Vec3 end = cylinder->half_length * s.axes.col(2);
    s.vertices = {s.center - end, s.center + end};
  } else if (const auto* ellipsoid = std::get_if<Ellipsoid>(&shape.geometry)) {
    s.kind = Solid::Kind::ellipsoid;
    s.half_extents = ellipsoid->radii;
    s.vertices = {s.center};
  } else if (const auto* hull = std::get_if<Hull>(&shape.geometry)) {
    s.kind = Solid::Kind::hull;
    s.center.setZero();
    for (const Vec3& v : hull->vertices) {
      s.vertices.push_back(pose.position + s.axes * v);
      s.center += s.vertices.back() / static_cast<double>(hull->vertices.size());
    }
    add_features(s);
  } else if (const auto* polygon = std::get_if<Polygon>(&shape.geometry)) {
    s.kind = Solid::Kind::polygon;
    s.planar = true;
    s.radius = polygon->radius;
    s.center.setZero();
    for (const Vec2& v : polygon->vertices) {
      s.vertices.push_back(pose.position + s.axes * Vec3(v.x(), v.y(), 0));
      s.center += s.vertices.back() / static_cast<double>(polygon->vertices.size());
    }
  } else if (const auto* terrain = std::get_if<Terrain>(&shape.geometry)) {
    // Clockwise around what is solid, or straight.
    s.planar = true;
    s.kind = terrain->loop ? Solid::Kind::polygon : Solid::Kind::half_space;
    s.center.setZero();
    for (auto p = terrain->points.rbegin(); p != terrain->points.rend(); ++p) {
      s.vertices.push_back(pose.position + s.axes * Vec3(p->x(), p->y(), 0));
      s.center += s.vertices.back() / static_cast<double>(terrain->points.size());
    }
    const Vec3 back = s.vertices.back() - s.vertices.front();
    s.normal = Vec3(back.y(), -back.x(), 0).normalized();
    s.offset = s.normal.dot(s.vertices.front());
  } else if (const auto* segment = std::get_if<Segment>(&shape.geometry)) {
    s.kind = Solid::Kind::capsule;
    s.planar = true;
    for (const Vec2& p : {segment->a, segment->b})
      s.vertices.push_back(pose.position + s.axes * Vec3(p.x(), p.y(), 0));
    s.center = 0.5 * (s.vertices[0] + s.vertices[1]);
  } else {
    s.kind = Solid::Kind::half_space;
    const auto* plane = std::get_if<Plane>(&shape.geometry);
    const auto* line = std::get_if<HalfPlane>(&shape.geometry);
    const Vec3 normal =
        plane != nullptr ? plane->normal : Vec3(line->normal.x(), line->normal.y(), 0);
    s.normal = (s.axes * normal).normalized();
    s.offset = (plane != nullptr ? plane->offset : line->offset) + s.normal.dot(pose.position);
  }
  return s;
}

double signed_distance(const Solid& s, const Vec3& p) {
  switch (s.kind) {
    case Solid::Kind::round: return (p - s.center).norm() - s.radius;
    case Solid::Kind::half_space: return s.normal.dot(p) - s.offset;
    case Solid::Kind::box: {
      const Vec3 q = (s.axes.transpose() * (p - s.center)).cwiseAbs() - s.half_extents;
      return q.maxCoeff() > 0 ? q.cwiseMax(0.0).norm() : q.maxCoeff();
    }
    case Solid::Kind::capsule: return point_segment(p, s.vertices[0], s.vertices[1]) - s.radius;
    case Solid::Kind::cylinder: return distance_to_cylinder(s, p);
    case Solid::Kind::hull: return distance_to_hull(s, p);
    case Solid::Kind::ellipsoid: return distance_to_ellipsoid(s, p);
    case Solid::Kind::polygon: {
      const auto sides = edges(s);
      const auto normals = edge_normals(s);
      double inside = -kInfinity, outside = kInfinity;
      for (std::size_t i = 0; i < sides.size(); ++i) {
        inside = std::max(inside, normals[i].dot(p - sides[i].first));
        outside = std::min(outside, point_segment(p, sides[i].first, sides[i].second));
      }
      return (inside > 0 ? outside : inside) - s.radius;
    }
  }
  return 0;
}

double separation_along(const Solid& a, const Solid& b, const Vec3& direction) {
  if (a.kind == Solid::Kind::half_space) {
    if (a.normal.dot(direction) < 1 - 1e-6) return -kInfinity;
    return extent(b, a.normal).first - a.offset;
  }
  if (b.kind == Solid::Kind::half_space) return separation_along(b, a, -direction);
  return extent(b, direction).first - extent(a, direction).second;
}

double separation(const Solid& a, const Solid& b) {
  if (a.kind == Solid::Kind::half_space) return separation_along(a, b, a.normal);
  if (b.kind == Solid::Kind::half_space) return separation_along(a, b, -b.normal);
  if (a.kind == Solid::Kind::round) return signed_distance(b, a.center) - a.radius;
  if (b.kind == Solid::Kind::round) return signed_distance(a, b.center) - b.radius;
  const auto searched = [](const Solid& s) {
    return s.kind == Solid::Kind::cylinder || s.kind == Solid::Kind::ellipsoid;
  };
  if (searched(a) || searched(b)) return searched_separation(a, b, facet_normals(a, b));
  return polytope_separation(a, b) - a.radius - b.radius;
}

std::optional<Vec3> exact_normal(const Solid& a, const Solid& b) {
  if (a.kind == Solid::Kind::half_space) return a.normal;
  if (b.kind == Solid::Kind::half_space) return -b.normal;
  if (b.kind == Solid::Kind::round) return outward(a, b.center);
  if (a.kind == Solid::Kind::round) {
    const auto n = outward(b, a.center);
    if (n) return -*n;
  }
  return std::nullopt;
}

}  // namespace manyworlds::test
