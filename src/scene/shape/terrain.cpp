// Terrains: chains of segments.
#include <algorithm>
#include <cmath>

#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker;

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
  for (std::size_t i = 0; i < n; ++i) good &= detail::check_point(checker, name(i), points[i]);
  if (!good) return;

  double extent = 0;  // m, farthest point from point 0
  for (const Vec2& p : points) extent = std::max(extent, (p - points[0]).norm());
  const double least = std::max(detail::kSameVertex * extent, detail::kMinSize);
  for (std::size_t i = terrain.loop ? 0 : 1; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    if ((points[i] - points[before]).norm() > least) continue;
    checker.add(name(i), "is " + detail::vector_text(points[i]) + " m, the same as " +
                             name(before) + "; neighbours must be apart");
    good = false;
  }
  if (!good) return;
  // A spike without width has no outside.
  for (std::size_t i = terrain.loop ? 0 : 1; i + (terrain.loop ? 0 : 1) < n; ++i) {
    const Vec2 before = (points[i] - points[(i + n - 1) % n]).normalized();
    const Vec2 after = (points[(i + 1) % n] - points[i]).normalized();
    if (before.dot(after) > 0 || std::abs(detail::cross(before, after)) > detail::kMinCornerSine)
      continue;
    checker.add(name(i),
                "at " + detail::vector_text(points[i]) + " m folds back, must bend by less");
  }
}

class TerrainTraits final : public TraitsOf<Terrain> {
 public:
  TerrainTraits() : TraitsOf({.name = "terrain", .in_plane = true, .ground = true}) {}

 protected:
  void examine(Checker& checker, const Terrain& terrain) const override {
    check_terrain(checker, terrain);
  }
  std::vector<Convex> parts_of(const Terrain& terrain, const Vec3& x, const Mat3& r,
                               Space space) const override {
    std::vector<Convex> links;
    const std::size_t n = terrain.points.size();
    const auto place = [&](std::size_t i) {
      return Vec3(x + r * detail::in_plane(terrain.points[i % n]));
    };
    for (std::size_t i = 0; i + (terrain.loop ? 0 : 1) < n; ++i) {
      links.push_back(segment_of(place(i), place(i + 1), 0, space));
    }
    return links;
  }
  Surface surface_of(const Terrain& terrain, const SurfaceOptions&) const override {
    std::vector<Vec3> line;
    for (const Vec2& p : terrain.points) line.push_back(detail::in_plane(p));
    Surface out;
    out.lines.push_back(terrain.loop ? detail::closed(std::move(line)) : std::move(line));
    return out;
  }
};

}  // namespace

MW_GEOMETRY(Terrain)

}  // namespace manyworlds
