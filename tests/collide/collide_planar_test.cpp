// Planar shape pairs against the slow twins: 10,000 random poses or more of each, in f32 and f64,
// between dynamic bodies and against fixed ones, with shapes on and off their body frames.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

constexpr int kPlanarScenes = 24;          // random sizes, offsets and vertex counts
constexpr int kPosesPerPlanarScene = 512;  // one round of worlds: 12,288 poses in all

Geometry any_circle(Random& r) { return Circle{r.uniform(0.1, 0.6)}; }
Geometry any_polygon(Random& r) { return random_polygon(r, r.integer(3, 8)); }
Geometry any_rectangle(Random& r) { return Polygon::box(r.uniform(0.1, 0.6), r.uniform(0.1, 0.6)); }
Geometry any_rounded(Random& r) {
  Polygon polygon = random_polygon(r, r.integer(3, 8));
  polygon.radius = r.uniform(0.02, 0.3);
  return polygon;
}
Geometry any_line(Random& r) {
  const Vec3 n = r.planar_direction();
  return HalfPlane{Vec2(n.x(), n.y()), r.uniform(-0.5, 0.5)};
}

Geometry any_segment(Random& r) {
  const Vec3 a = r.in_cube(0.8), b = r.in_cube(0.8);
  return Segment{a.head<2>(), b.head<2>()};
}
// Straight, of segments of any length: all in all a half-plane.
Geometry any_flat_terrain(Random& r) {
  Terrain terrain;
  const Vec3 along = r.planar_direction();
  for (double x = -6; x < 6; x += r.uniform(0.1, 0.9))
    terrain.points.push_back(x * along.head<2>());
  return terrain;
}
// A convex hill: all in all a polygon.
Geometry any_hill(Random& r) {
  Polygon outline = random_polygon(r, r.integer(3, 8));
  std::reverse(outline.vertices.begin(), outline.vertices.end());
  return Terrain{outline.vertices, true};
}
// Shapes whose middle stays in front of a terrain however deep they are in it.
Geometry plump_circle(Random& r) { return Circle{r.uniform(0.15, 0.6)}; }
Geometry plump_rectangle(Random& r) {
  return Polygon::box(r.uniform(0.15, 0.6), r.uniform(0.15, 0.6));
}
Geometry plump_polygon(Random& r) {
  const int sides = r.integer(5, 8);
  Polygon p;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * i / sides;
    p.vertices.emplace_back(0.3 * std::cos(angle), 0.25 * std::sin(angle));
  }
  return p;
}
Geometry plump_capsule(Random& r) { return Capsule{r.uniform(0.15, 0.4), r.uniform(0.05, 0.6)}; }

Geometry plump_rounded(Random& r) {
  Polygon polygon = std::get<Polygon>(plump_polygon(r));
  polygon.radius = r.uniform(0.05, 0.2);
  return polygon;
}

void check_planar(ShapeMaker first, Motion first_motion, ShapeMaker second, int max_points) {
  PairPromise promise;
  promise.max_points = max_points;
  // Edges of one polygon win near ties with those of the other (polygon_pairs.hpp).
  if (max_points >= 2) promise.bias = 0.5 * test::kPairSlop;
  for (const Table& table : widest_tables()) {
    const PairResult sum =
        check_random_pairs({first, first_motion, second}, Space::planar, table, promise,
                           kPlanarScenes, kPosesPerPlanarScene, Random(20240602));
    INFO(name(table) << ": " << sum.deviations << " deviations in " << sum.poses << " poses\n"
                     << sum.report);
    CHECK(sum.deviations == 0);
    CHECK(sum.poses >= 10000);
    CHECK(sum.overlapping > sum.poses / 3);
    CHECK(sum.with_contacts >= sum.overlapping - sum.poses / 1000);
  }
}

}  // namespace

TEST_CASE("circle-circle agrees with its twin", "[slow][collide]") {
  check_planar(any_circle, Motion::dynamic, any_circle, 1);
}
TEST_CASE("circle against a fixed circle agrees with its twin", "[slow][collide]") {
  check_planar(any_circle, Motion::fixed, any_circle, 1);
}
TEST_CASE("circle-halfplane agrees with its twin", "[slow][collide]") {
  check_planar(any_line, Motion::fixed, any_circle, 1);
}
TEST_CASE("circle-polygon agrees with its twin", "[slow][collide]") {
  check_planar(any_polygon, Motion::dynamic, any_circle, 1);
}
TEST_CASE("circle-rectangle agrees with its twin", "[slow][collide]") {
  check_planar(any_circle, Motion::dynamic, any_rectangle, 1);
}
TEST_CASE("circle against a fixed polygon agrees with its twin", "[slow][collide]") {
  check_planar(any_polygon, Motion::fixed, any_circle, 1);
}
TEST_CASE("polygon against a fixed circle agrees with its twin", "[slow][collide]") {
  check_planar(any_circle, Motion::fixed, any_polygon, 1);
}
TEST_CASE("polygon-halfplane agrees with its twin", "[slow][collide]") {
  check_planar(any_line, Motion::fixed, any_polygon, 2);
}
TEST_CASE("polygon-polygon agrees with its twin", "[slow][collide]") {
  check_planar(any_polygon, Motion::dynamic, any_polygon, 2);
}
TEST_CASE("polygon-rectangle agrees with its twin", "[slow][collide]") {
  check_planar(any_rectangle, Motion::dynamic, any_polygon, 2);
}
TEST_CASE("rectangle-rectangle agrees with its twin", "[slow][collide]") {
  check_planar(any_rectangle, Motion::dynamic, any_rectangle, 2);
}
TEST_CASE("polygon against a fixed polygon agrees with its twin", "[slow][collide]") {
  check_planar(any_polygon, Motion::fixed, any_polygon, 2);
}

TEST_CASE("capsule-circle agrees with its planar twin", "[slow][collide]") {
  check_planar(any_capsule, Motion::dynamic, any_circle, 1);
}
TEST_CASE("circle against a fixed capsule agrees with its planar twin", "[slow][collide]") {
  check_planar(any_capsule, Motion::fixed, any_circle, 1);
}
TEST_CASE("capsule against a fixed circle agrees with its planar twin", "[slow][collide]") {
  check_planar(any_circle, Motion::fixed, any_capsule, 1);
}
TEST_CASE("capsule-halfplane agrees with its twin", "[slow][collide]") {
  check_planar(any_line, Motion::fixed, any_capsule, 2);
}
TEST_CASE("capsule-capsule agrees with its planar twin", "[slow][collide]") {
  check_planar(any_capsule, Motion::dynamic, any_capsule, 2);
}
TEST_CASE("capsule against a fixed capsule agrees with its planar twin", "[slow][collide]") {
  check_planar(any_capsule, Motion::fixed, any_capsule, 2);
}
TEST_CASE("rectangle-capsule agrees with its twin", "[slow][collide]") {
  check_planar(any_rectangle, Motion::dynamic, any_capsule, 2);
}
TEST_CASE("polygon-capsule agrees with its twin", "[slow][collide]") {
  check_planar(any_polygon, Motion::dynamic, any_capsule, 2);
}
TEST_CASE("capsule against a fixed polygon agrees with its twin", "[slow][collide]") {
  check_planar(any_polygon, Motion::fixed, any_capsule, 2);
}
TEST_CASE("rectangle against a fixed capsule agrees with its twin", "[slow][collide]") {
  check_planar(any_capsule, Motion::fixed, any_rectangle, 2);
}
TEST_CASE("polygon against a fixed capsule agrees with its twin", "[slow][collide]") {
  check_planar(any_capsule, Motion::fixed, any_polygon, 2);
}

TEST_CASE("circle-segment agrees with its twin", "[slow][collide]") {
  check_planar(any_segment, Motion::fixed, any_circle, 1);
}
TEST_CASE("rectangle-segment agrees with its twin", "[slow][collide]") {
  check_planar(any_segment, Motion::fixed, any_rectangle, 2);
}
TEST_CASE("polygon-segment agrees with its twin", "[slow][collide]") {
  check_planar(any_segment, Motion::fixed, any_polygon, 2);
}
TEST_CASE("capsule-segment agrees with its twin", "[slow][collide]") {
  check_planar(any_segment, Motion::fixed, any_capsule, 2);
}

TEST_CASE("rounded polygon-circle agrees with its twin", "[slow][collide]") {
  check_planar(any_rounded, Motion::dynamic, any_circle, 1);
}
TEST_CASE("rounded polygon against a fixed circle agrees with its twin", "[slow][collide]") {
  check_planar(any_circle, Motion::fixed, any_rounded, 1);
}
TEST_CASE("rounded polygon-halfplane agrees with its twin", "[slow][collide]") {
  check_planar(any_line, Motion::fixed, any_rounded, 2);
}
TEST_CASE("rounded polygons agree with their twin", "[slow][collide]") {
  check_planar(any_rounded, Motion::dynamic, any_rounded, 2);
}
TEST_CASE("rounded polygon against a fixed one agrees with its twin", "[slow][collide]") {
  check_planar(any_rounded, Motion::fixed, any_rounded, 2);
}
TEST_CASE("rounded polygon-sharp polygon agrees with its twin", "[slow][collide]") {
  check_planar(any_rounded, Motion::dynamic, any_polygon, 2);
}
TEST_CASE("rounded polygon-capsule agrees with its twin", "[slow][collide]") {
  check_planar(any_rounded, Motion::dynamic, any_capsule, 2);
}
TEST_CASE("rounded polygon against a fixed capsule agrees with its twin", "[slow][collide]") {
  check_planar(any_capsule, Motion::fixed, any_rounded, 2);
}
TEST_CASE("rounded polygon-segment agrees with its twin", "[slow][collide]") {
  check_planar(any_segment, Motion::fixed, any_rounded, 2);
}

// A terrain gives points for every link that a shape is near.
constexpr int kAnyNumber = 100;

TEST_CASE("a straight terrain is a half-plane to circles", "[slow][collide]") {
  check_planar(any_flat_terrain, Motion::fixed, plump_circle, kAnyNumber);
}
TEST_CASE("a straight terrain is a half-plane to rectangles", "[slow][collide]") {
  check_planar(any_flat_terrain, Motion::fixed, plump_rectangle, kAnyNumber);
}
TEST_CASE("a straight terrain is a half-plane to polygons", "[slow][collide]") {
  check_planar(any_flat_terrain, Motion::fixed, plump_polygon, kAnyNumber);
}
TEST_CASE("a straight terrain is a half-plane to capsules", "[slow][collide]") {
  check_planar(any_flat_terrain, Motion::fixed, plump_capsule, kAnyNumber);
}
TEST_CASE("a straight terrain is a half-plane to rounded polygons", "[slow][collide]") {
  check_planar(any_flat_terrain, Motion::fixed, plump_rounded, kAnyNumber);
}
TEST_CASE("a convex loop of terrain is a polygon to circles", "[slow][collide]") {
  check_planar(any_hill, Motion::fixed, plump_circle, kAnyNumber);
}
TEST_CASE("a convex loop of terrain is a polygon to capsules", "[slow][collide]") {
  check_planar(any_hill, Motion::fixed, plump_capsule, kAnyNumber);
}

}  // namespace manyworlds::test
