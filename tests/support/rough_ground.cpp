#include "tests/support/rough_ground.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "tests/support/height_field.hpp"

namespace manyworlds::test {
namespace {

constexpr double kStride = 2e-3;  // m; thinner necks of the ground are walked over
constexpr double kFarthest = 2;   // m

// How far it is from a point that is inside along a unit direction to where that ends.
double way_out(const Vec3& from, const Vec3& direction,
               const std::function<bool(const Vec3&)>& inside) {
  double in = 0, out = kStride;
  while (out < kFarthest && inside(from + out * direction)) in = out, out += kStride;
  while (out - in > 1e-7) {
    const double middle = 0.5 * (in + out);
    (inside(from + middle * direction) ? in : out) = middle;
  }
  return out;
}

double height_of(const Terrain& terrain, double x) {
  for (std::size_t i = 0; i + 1 < terrain.points.size(); ++i) {
    const Vec2 a = terrain.points[i], b = terrain.points[i + 1];
    if (a.x() <= x && x <= b.x()) return a.y() + (b - a).y() * (x - a.x()) / (b - a).x();
  }
  return -std::numeric_limits<double>::infinity();
}

}  // namespace

bool RoughGround::contains(const Vec3& p) const {
  if (const auto* terrain = std::get_if<Terrain>(&geometry_)) {
    return p.y() <= height_of(*terrain, p.x());
  }
  const auto& field = std::get<HeightField>(geometry_);
  return p.z() <= surface(field, p.x(), p.y());
}

double overlap_at(const RoughGround& ground, const Solid& body, const Vec3& point,
                  const Vec3& normal, double depth, double slack) {
  const auto in_body = [&](const Vec3& p) { return signed_distance(body, p) <= slack; };
  const auto in_ground = [&](const Vec3& p) { return ground.contains(p - slack * normal); };
  const Vec3 of_body = point - 0.5 * depth * normal, of_ground = point + 0.5 * depth * normal;
  double out = 0;
  if (in_body(of_body) && in_ground(of_body)) out = way_out(of_body, normal, in_ground);
  if (in_ground(of_ground) && in_body(of_ground)) {
    out = std::max(out, way_out(of_ground, -normal, in_body));
  }
  return out;
}

}  // namespace manyworlds::test
