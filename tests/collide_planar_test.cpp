// Planar shape pairs against the slow twins: 10,000 random poses or more of each, in f32 and f64,
// between dynamic bodies and against fixed ones, with shapes on and off their body frames.
#include <catch2/catch.hpp>

#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

constexpr int kScenes = 24;          // random sizes, offsets and vertex counts
constexpr int kPosesPerScene = 512;  // one round of worlds: 12,288 poses in all

using Maker = Geometry (*)(Random&);

Geometry any_circle(Random& r) { return Circle{r.uniform(0.1, 0.6)}; }
Geometry any_polygon(Random& r) { return random_polygon(r, r.integer(3, 8)); }
Geometry any_rectangle(Random& r) { return Polygon::box(r.uniform(0.1, 0.6), r.uniform(0.1, 0.6)); }
Geometry any_capsule(Random& r) { return random_capsule(r); }
Geometry any_line(Random& r) {
  const Vec3 n = r.planar_direction();
  return HalfPlane{Vec2(n.x(), n.y()), r.uniform(-0.5, 0.5)};
}

void check(Maker first, Motion first_motion, Maker second, int max_points) {
  PairPromise promise;
  promise.max_points = max_points;
  // Edges of one polygon win near ties with those of the other (polygon_pairs.hpp).
  if (max_points == 2) promise.bias = 0.5 * Options{}.slop;
  for (const Table& table : widest_tables()) {
    Random random(20240602);
    PairResult sum;
    for (int i = 0; i < kScenes; ++i) {
      Scene scene = empty_scene(Space::planar, 0);
      const bool offset = i % 2 == 1;
      scene.add(random_body(first(random), first_motion, offset, Space::planar, random));
      scene.add(random_body(second(random), Motion::dynamic, offset, Space::planar, random));
      if (i % 4 >= 2) std::swap(scene.bodies[0], scene.bodies[1]);
      merge(sum, check_pair(scene, table, promise, kPosesPerScene, random));
    }
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
  check(any_circle, Motion::dynamic, any_circle, 1);
}
TEST_CASE("circle against a fixed circle agrees with its twin", "[slow][collide]") {
  check(any_circle, Motion::fixed, any_circle, 1);
}
TEST_CASE("circle-halfplane agrees with its twin", "[slow][collide]") {
  check(any_line, Motion::fixed, any_circle, 1);
}
TEST_CASE("circle-polygon agrees with its twin", "[slow][collide]") {
  check(any_polygon, Motion::dynamic, any_circle, 1);
}
TEST_CASE("circle-rectangle agrees with its twin", "[slow][collide]") {
  check(any_circle, Motion::dynamic, any_rectangle, 1);
}
TEST_CASE("circle against a fixed polygon agrees with its twin", "[slow][collide]") {
  check(any_polygon, Motion::fixed, any_circle, 1);
}
TEST_CASE("polygon against a fixed circle agrees with its twin", "[slow][collide]") {
  check(any_circle, Motion::fixed, any_polygon, 1);
}
TEST_CASE("polygon-halfplane agrees with its twin", "[slow][collide]") {
  check(any_line, Motion::fixed, any_polygon, 2);
}
TEST_CASE("polygon-polygon agrees with its twin", "[slow][collide]") {
  check(any_polygon, Motion::dynamic, any_polygon, 2);
}
TEST_CASE("polygon-rectangle agrees with its twin", "[slow][collide]") {
  check(any_rectangle, Motion::dynamic, any_polygon, 2);
}
TEST_CASE("rectangle-rectangle agrees with its twin", "[slow][collide]") {
  check(any_rectangle, Motion::dynamic, any_rectangle, 2);
}
TEST_CASE("polygon against a fixed polygon agrees with its twin", "[slow][collide]") {
  check(any_polygon, Motion::fixed, any_polygon, 2);
}

TEST_CASE("capsule-circle agrees with its planar twin", "[slow][collide]") {
  check(any_capsule, Motion::dynamic, any_circle, 1);
}
TEST_CASE("circle against a fixed capsule agrees with its planar twin", "[slow][collide]") {
  check(any_capsule, Motion::fixed, any_circle, 1);
}
TEST_CASE("capsule against a fixed circle agrees with its planar twin", "[slow][collide]") {
  check(any_circle, Motion::fixed, any_capsule, 1);
}
TEST_CASE("capsule-halfplane agrees with its twin", "[slow][collide]") {
  check(any_line, Motion::fixed, any_capsule, 2);
}
TEST_CASE("capsule-capsule agrees with its planar twin", "[slow][collide]") {
  check(any_capsule, Motion::dynamic, any_capsule, 2);
}
TEST_CASE("capsule against a fixed capsule agrees with its planar twin", "[slow][collide]") {
  check(any_capsule, Motion::fixed, any_capsule, 2);
}
TEST_CASE("rectangle-capsule agrees with its twin", "[slow][collide]") {
  check(any_rectangle, Motion::dynamic, any_capsule, 2);
}
TEST_CASE("polygon-capsule agrees with its twin", "[slow][collide]") {
  check(any_polygon, Motion::dynamic, any_capsule, 2);
}
TEST_CASE("capsule against a fixed polygon agrees with its twin", "[slow][collide]") {
  check(any_polygon, Motion::fixed, any_capsule, 2);
}
TEST_CASE("rectangle against a fixed capsule agrees with its twin", "[slow][collide]") {
  check(any_capsule, Motion::fixed, any_rectangle, 2);
}
TEST_CASE("polygon against a fixed capsule agrees with its twin", "[slow][collide]") {
  check(any_capsule, Motion::fixed, any_polygon, 2);
}

}  // namespace manyworlds::test
