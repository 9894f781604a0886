#include "tests/support/large_hulls.hpp"

#include <cmath>

#include "manyworlds/hull.hpp"

namespace manyworlds::test {

namespace {

Vec3 radii_of(int kind, Random& random) {
  const double a = random.uniform(0.2, 0.6), b = random.uniform(0.2, 0.6);
  if (kind == 1) return {0.03 * a, 0.03 * b, 0.6};
  if (kind == 2) return {a, b, 0.03};
  return {a, b, random.uniform(0.2, 0.6)};
}

// On the unit ball for most kinds.
Vec3 point_of(int kind, int i, int corners, Random& random) {
  if (kind == 4) {
    const double angle = 2 * M_PI * (i / 2) / (corners / 2);
    return {std::cos(angle), std::sin(angle), i % 2 ? 1.0 : -1.0};
  }
  Vec3 way = random.direction();
  if (kind == 3) return (way * 1.2).cwiseMax(-1).cwiseMin(1) * 0.95 + 0.05 * way;
  if (kind == 5) {
    way.z() = std::abs(way.z());
    way.head<2>() *= random.log_uniform(0.05, 1);
    way.normalize();
  }
  return way;
}

}  // namespace

Hull large_hull(int kind, int corners, Random& random) {
  const Vec3 radii = radii_of(kind, random), middle = random.in_cube(0.1);
  std::vector<Vec3> points;
  for (int i = 0; i < corners; ++i) {
    points.push_back(middle + radii.cwiseProduct(point_of(kind, i, corners, random)));
  }
  return make_hull(points);
}

}  // namespace manyworlds::test
