#include "tests/support/solid_convex.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/scene/convex_search.hpp"

namespace manyworlds::test {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();

}  // namespace

double point_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 d = b - a;
  const double t = std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0);
  return (p - a - t * d).norm();
}

// What is round but no ball has no list of normals: the sphere is searched, coarsely at first, then
// from the best places in ever smaller steps. As good as kSearched.
double searched_separation(Solid a, Solid b, std::vector<Vec3> looks) {
  const double radii = a.radius + b.radius;
  a.radius = b.radius = 0;
  if (a.kind == Solid::Kind::round)
    a.kind = Solid::Kind::capsule, a.vertices = {a.center, a.center};
  if (b.kind == Solid::Kind::round)
    b.kind = Solid::Kind::capsule, b.vertices = {b.center, b.center};
  constexpr int kCoarse = 200;
  for (int i = 0; i < kCoarse; ++i) {
    const double z = 1 - (2 * i + 1.0) / kCoarse, angle = i * 2.399963229728653;
    looks.push_back(
        {std::sqrt(1 - z * z) * std::cos(angle), std::sqrt(1 - z * z) * std::sin(angle), z});
  }
  for (const Solid* s : {&a, &b}) {
    if (s->kind != Solid::Kind::cylinder) continue;
    const Vec3 axis = s->axes.col(2), d = b.center - a.center;
    for (const Vec3& n : {axis, Vec3((d - axis * axis.dot(d)).normalized())}) {
      looks.push_back(n);
      looks.push_back(-n);
    }
  }
  // What the library finds is a separation too, whatever it did to find it.
  const auto convex = [](const Solid& s) {
    Convex c;
    c.points = s.vertices;
    c.axes = s.axes;
    c.radii = s.kind == Solid::Kind::ellipsoid ? s.half_extents : Vec3(s.disc, s.disc, 0);
    return c;
  };
  looks.push_back(search_separation(convex(a), convex(b)).normal);
  std::vector<std::pair<double, Vec3>> best;
  for (const Vec3& n : looks) best.emplace_back(separation_along(a, b, n), n);
  const std::size_t starts = 6;
  std::partial_sort(best.begin(), best.begin() + starts, best.end(),
                    [](const auto& x, const auto& y) { return x.first > y.first; });
  double result = -kUnbounded;
  for (std::size_t i = 0; i < starts; ++i) {
    auto [s, n] = best[i];
    double phase = 0;
    for (double step = 0.2; step > 1e-9;) {
      const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
      const double before = s;
      const Vec3 from = n;
      for (int k = 0; k < 8; ++k) {
        const double angle = phase + k * 0.7853981633974483;
        const Vec3 m = (from + step * (std::cos(angle) * u + std::sin(angle) * v)).normalized();
        const double there = separation_along(a, b, m);
        if (there > s) s = there, n = m;
      }
      phase += 0.377;
      if (!(s > before)) step *= 0.6;
    }
    result = std::max(result, s);
  }
  return result - radii;
}

// From a point outside of a hull the nearest is on a face, where that is the one it is farthest in
// front of, or on an edge.
double distance_to_hull(const Solid& s, const Vec3& p) {
  double inside = -kUnbounded, outside = kUnbounded;
  Vec3 foot = p;
  for (const auto& [point, n] : s.sides) {
    const double height = n.dot(p - point);
    if (height > inside) inside = height, foot = p - height * n;
  }
  if (inside <= 0) return inside;
  double over = -kUnbounded;
  for (const auto& [point, n] : s.sides) over = std::max(over, n.dot(foot - point));
  if (over <= 1e-12) return inside;
  for (const auto& [a, b] : s.rims) outside = std::min(outside, point_segment(p, a, b));
  return outside;
}

double distance_to_cylinder(const Solid& s, const Vec3& p) {
  const double height = s.axes.col(2).dot(p - s.center);
  const double half = 0.5 * (s.vertices[1] - s.vertices[0]).norm();
  const double gr = (p - s.center - height * s.axes.col(2)).norm() - s.disc;
  const double gz = std::abs(height) - half;
  return std::max(gr, gz) > 0 ? std::hypot(std::max(gr, 0.0), std::max(gz, 0.0)) : std::max(gr, gz);
}

// Every plane through three vertices that has all others behind it is a face, and two vertices that
// share two faces have an edge between them.
void add_features(Solid& s) {
  const std::vector<Vec3>& v = s.vertices;
  const std::size_t n = v.size();
  std::vector<std::vector<bool>> on;  // [face][vertex]
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t k = i + 1; k < n; ++k) {
        if (j <= i || j == k) continue;
        const Vec3 normal = (v[j] - v[i]).cross(v[k] - v[i]).normalized();
        std::vector<bool> there(n);
        bool face = true;
        for (std::size_t l = 0; l < n && face; ++l) {
          const double height = normal.dot(v[l] - v[i]);
          face = height < 1e-9;
          there[l] = height > -1e-9;
        }
        if (!face || std::find(on.begin(), on.end(), there) != on.end()) continue;
        on.push_back(there);
        s.sides.emplace_back(v[i], normal);
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) {
      int common = 0;
      for (const auto& face : on) common += face[i] && face[j] ? 1 : 0;
      if (common >= 2) s.rims.emplace_back(v[i], v[j]);
    }
  }
}

std::optional<Vec3> outward_of_cylinder(const Solid& s, const Vec3& p, double clear) {
  const Vec3 axis = s.axes.col(2);
  const double height = axis.dot(p - s.center);
  const Vec3 out = p - s.center - height * axis;
  if (out.norm() < clear || std::abs(height) < clear) return std::nullopt;
  const double half = 0.5 * (s.vertices[1] - s.vertices[0]).norm();
  const double gr = out.norm() - s.disc, gz = std::abs(height) - half;
  const Vec3 radial = out.normalized(), up = height > 0 ? axis : Vec3(-axis);
  if (std::max(gr, gz) > 0) {
    const double x = std::max(gr, 0.0), z = std::max(gz, 0.0);
    if (std::hypot(x, z) < clear) return std::nullopt;
    return (x * radial + z * up).normalized();
  }
  if (std::abs(gr - gz) < clear) return std::nullopt;
  return gr > gz ? radial : up;
}

std::optional<Vec3> outward_of_hull(const Solid& s, const Vec3& p, double clear) {
  double first = -kUnbounded, second = -kUnbounded;
  Vec3 normal = Vec3::Zero();
  for (const auto& [point, n] : s.sides) {
    const double height = n.dot(p - point);
    if (height > first) {
      second = first, first = height, normal = n;
    } else {
      second = std::max(second, height);
    }
  }
  if (first > 0) {
    const double distance = distance_to_hull(s, p);
    if (distance < clear || (distance > first && distance < first + 1e-9)) return std::nullopt;
    if (distance == first) return normal;
    Vec3 nearest = p;
    double best = kUnbounded;
    for (const auto& [a, b] : s.rims) {
      const Vec3 d = b - a;
      const Vec3 q = a + std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d;
      if ((p - q).norm() < best) best = (p - q).norm(), nearest = q;
    }
    return (p - nearest).normalized();
  }
  if (second > first - clear) return std::nullopt;
  return normal;
}

namespace {

// The point of an ellipsoid nearest to one in its axes: x = r^2 y / (t + r^2) with the t for which
// it is on the surface (Eberly, "Distance from a point to an ellipse, an ellipsoid, or a
// hyperellipsoid"), by bisection.
Vec3 nearest_on_ellipsoid(const Vec3& radii, const Vec3& y) {
  const Vec3 squares = radii.cwiseAbs2();
  const auto at = [&](double t) {
    return Vec3(squares.cwiseProduct(y).cwiseQuotient(squares + Vec3::Constant(t)));
  };
  double low = -squares.minCoeff(), high = radii.maxCoeff() * y.norm() + 1;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    const bool outside = at(middle).cwiseQuotient(radii).squaredNorm() > 1;
    (outside ? low : high) = middle;
  }
  return at(high);
}

}  // namespace

double distance_to_ellipsoid(const Solid& s, const Vec3& p) {
  const Vec3 y = s.axes.transpose() * (p - s.center);
  const double distance = (y - nearest_on_ellipsoid(s.half_extents, y)).norm();
  return y.cwiseQuotient(s.half_extents).squaredNorm() < 1 ? -distance : distance;
}

std::optional<Vec3> outward_of_ellipsoid(const Solid& s, const Vec3& p, double clear) {
  if (distance_to_ellipsoid(s, p) < clear) return std::nullopt;  // inside there are ridges
  const Vec3 y = s.axes.transpose() * (p - s.center);
  return s.axes * (y - nearest_on_ellipsoid(s.half_extents, y)).normalized();
}

}  // namespace manyworlds::test
