// The method of kernels/collide/convex_axes.cpp, in double and for one pair: from the best of some
// normals GJK goes up hill, towards a target that moves.
#include "src/scene/convex_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace manyworlds {

namespace {

struct Corner {
  Vec3 w, a;  // b - a, and a
};

// Weights of the corners of a triangle, at its point nearest to the origin.
Vec3 nearest_on_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  Vec3 best(1, 0, 0);
  double least = std::numeric_limits<double>::max();
  const Vec3 corner[3] = {a, b, c};
  const auto take = [&](const Vec3& weights) {
    const double d2 = (a * weights[0] + b * weights[1] + c * weights[2]).squaredNorm();
    if (d2 < least) least = d2, best = weights;
  };
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    const Vec3 way = corner[j] - corner[i];
    const double l2 = way.squaredNorm();
    const double share = l2 > 0 ? std::clamp(-corner[i].dot(way) / l2, 0.0, 1.0) : 0;
    Vec3 weights = Vec3::Zero();
    weights[i] = 1 - share, weights[j] = share;
    take(weights);
  }
  const Vec3 n = (b - a).cross(c - a);
  const double nn = n.squaredNorm();
  const double v = n.dot((c - a).cross(a)), w = n.dot(a.cross(b - a)), u = nn - v - w;
  const double thin = 1e-18 * (b - a).squaredNorm() * (c - a).squaredNorm();
  if (nn > thin && u >= 0 && v >= 0 && w >= 0) take(Vec3(u, v, w) / nn);
  return best;
}

}  // namespace

Separation search_separation(const Convex& a, const Convex& b) {
  const auto corner_along = [&](const Vec3& n) {
    const Vec3 on_a = a.support(n);
    return Corner{b.support(-n) - on_a, on_a};
  };
  double best = -std::numeric_limits<double>::max();
  Vec3 normal = Vec3::UnitZ();
  const auto look = [&](const Vec3& n) {
    if (!(n.norm() > 1e-9)) return;
    for (const Vec3& m : {Vec3(n.normalized()), Vec3(-n.normalized())}) {
      const double s = m.dot(corner_along(m).w);
      if (s > best) best = s, normal = m;
    }
  };
  const auto middle = [](const Convex& c) {
    Vec3 sum = Vec3::Zero();
    for (const Vec3& p : c.points) sum += p / static_cast<double>(c.points.size());
    return sum;
  };
  const Vec3 between = middle(b) - middle(a);
  look(between);
  for (const Convex* c : {&a, &b}) {
    for (const Vec3& n : c->normals) look(n);
    if (c->radii.x() > 0 && c->radii.z() == 0)
      look(between - c->axes.col(2) * between.dot(c->axes.col(2)));
  }
  if (few_crossings(a, b)) {
    for (const Vec3& u : a.directions) {
      for (const Vec3& v : b.directions) look(u.cross(v));
    }
  }

  Vec3 on_a = Vec3::Zero(), on_b = Vec3::Zero();
  // With a fixed target, the origin, it finds out whether they are apart.
  const auto climb = [&](Vec3 start, bool fixed_target) {
    constexpr int kRounds = 200;
    const double tolerance = 1e-13 * (1 + between.norm());
    Corner corner[4];
    corner[0] = corner[1] = corner[2] = corner[3] = corner_along(start);
    double reached = start.dot(corner[0].w);
    Vec3 near_a = corner[0].a, near_b = near_a + corner[0].w;
    for (int round = 0; round < kRounds; ++round) {
      const Vec3 target = fixed_target ? Vec3::Zero() : Vec3(start * std::min(reached, 0.0));
      constexpr int kTriangle[4][3] = {{0, 1, 2}, {3, 0, 1}, {3, 1, 2}, {3, 2, 0}};
      double least = std::numeric_limits<double>::max();
      Vec3 way = Vec3::Zero();
      Corner next[3] = {corner[0], corner[1], corner[2]};
      for (const auto& t : kTriangle) {
        const Corner &x = corner[t[0]], &y = corner[t[1]], &z = corner[t[2]];
        const Vec3 weight = nearest_on_triangle(x.w - target, y.w - target, z.w - target);
        const Vec3 w = x.w * weight[0] + y.w * weight[1] + z.w * weight[2];
        if (!((w - target).squaredNorm() < least)) continue;
        way = w - target;
        least = way.squaredNorm();
        near_a = x.a * weight[0] + y.a * weight[1] + z.a * weight[2];
        near_b = near_a + w;
        next[0] = x, next[1] = y, next[2] = z;
      }
      std::copy(next, next + 3, corner);
      if (way.norm() - std::max(reached, 0.0) <= tolerance) break;
      const Vec3 n = way.normalized();
      corner[3] = corner_along(n);
      const double s = n.dot(corner[3].w);
      if (s > reached) reached = s, start = n;
    }
    if (reached < best) return;
    best = reached, normal = start;
    on_a = near_a, on_b = near_b;
  };
  const Vec3 first = normal;
  climb(first, true);
  if (best < 0) {
    climb(normal, false);
    climb(first, false);
    if (between.norm() > 0) climb(between.normalized(), false);
  }
  Separation out;
  out.distance = best - a.radius - b.radius;
  out.normal = normal;
  out.point_a = on_a + normal * a.radius;
  out.point_b = out.point_a + normal * out.distance;
  return out;
}

}  // namespace manyworlds
