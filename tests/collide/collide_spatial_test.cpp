// Spatial shape pairs against the slow twins: 10,000 random poses or more of each, in f32 and f64,
// between dynamic bodies and against fixed ones, with shapes on and off their body frames.
#include <catch2/catch.hpp>

#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

constexpr int kSpatialScenes = 8;            // random sizes and offsets
constexpr int kPosesPerSpatialScene = 1536;  // three rounds of worlds: 12,288 poses in all

void check_solids(ShapeMaker first, Motion first_motion, ShapeMaker second,
                  const PairPromise& promise) {
  for (const Table& table : widest_tables()) {
    const PairResult sum =
        check_random_pairs({first, first_motion, second}, Space::spatial, table, promise,
                           kSpatialScenes, kPosesPerSpatialScene, Random(20240601));
    INFO(name(table) << ": " << sum.deviations << " deviations in " << sum.poses << " poses\n"
                     << sum.report);
    CHECK(sum.deviations == 0);
    CHECK(sum.poses >= 10000);
    CHECK(sum.overlapping > sum.poses / 3);  // the poses do test something
    CHECK(sum.with_contacts >= sum.overlapping - sum.poses / 1000);
  }
}

// A box prefers a face of A to one of B that is shallower by up to half a slop, and a face to an
// edge that is shallower by half a slop and 5 % of the face's depth (box_box_axes.hpp).
PairPromise box_box_promise() {
  PairPromise p;
  const double half_slop = 0.5 * test::kPairSlop;
  p.bias = half_slop / 0.95 + half_slop;
  p.bias_relative = 0.05 / 0.95;
  p.reach = 1.5;
  p.max_points = 4;
  return p;
}

// A box prefers a face to an edge that is shallower by half a slop (box_capsule.hpp).
PairPromise box_capsule_promise() {
  PairPromise p = points(2);
  p.bias = 0.5 * test::kPairSlop;
  return p;
}

}  // namespace

TEST_CASE("sphere-sphere agrees with its twin", "[slow][collide]") {
  check_solids(any_sphere, Motion::dynamic, any_sphere, points(1));
}
TEST_CASE("sphere against a fixed sphere agrees with its twin", "[slow][collide]") {
  check_solids(any_sphere, Motion::fixed, any_sphere, points(1));
}
TEST_CASE("sphere-plane agrees with its twin", "[slow][collide]") {
  check_solids(any_plane, Motion::fixed, any_sphere, points(1));
}
TEST_CASE("sphere-box agrees with its twin", "[slow][collide]") {
  check_solids(any_sphere, Motion::dynamic, any_box, points(1));
}
TEST_CASE("sphere against a fixed box agrees with its twin", "[slow][collide]") {
  check_solids(any_box, Motion::fixed, any_sphere, points(1));
}
TEST_CASE("box against a fixed sphere agrees with its twin", "[slow][collide]") {
  check_solids(any_sphere, Motion::fixed, any_box, points(1));
}
TEST_CASE("box-plane agrees with its twin", "[slow][collide]") {
  check_solids(any_plane, Motion::fixed, any_box, points(4));
}
TEST_CASE("box-box agrees with its twin", "[slow][collide]") {
  check_solids(any_box, Motion::dynamic, any_box, box_box_promise());
}
TEST_CASE("box against a fixed box agrees with its twin", "[slow][collide]") {
  check_solids(any_box, Motion::fixed, any_box, box_box_promise());
}

TEST_CASE("capsule-sphere agrees with its twin", "[slow][collide]") {
  check_solids(any_capsule, Motion::dynamic, any_sphere, points(1));
}
TEST_CASE("sphere against a fixed capsule agrees with its twin", "[slow][collide]") {
  check_solids(any_capsule, Motion::fixed, any_sphere, points(1));
}
TEST_CASE("capsule against a fixed sphere agrees with its twin", "[slow][collide]") {
  check_solids(any_sphere, Motion::fixed, any_capsule, points(1));
}
TEST_CASE("capsule-plane agrees with its twin", "[slow][collide]") {
  check_solids(any_plane, Motion::fixed, any_capsule, points(2));
}
TEST_CASE("capsule-capsule agrees with its twin", "[slow][collide]") {
  check_solids(any_capsule, Motion::dynamic, any_capsule, points(2));
}
TEST_CASE("capsule against a fixed capsule agrees with its twin", "[slow][collide]") {
  check_solids(any_capsule, Motion::fixed, any_capsule, points(2));
}
TEST_CASE("box-capsule agrees with its twin", "[slow][collide]") {
  check_solids(any_box, Motion::dynamic, any_capsule, box_capsule_promise());
}
TEST_CASE("capsule against a fixed box agrees with its twin", "[slow][collide]") {
  check_solids(any_box, Motion::fixed, any_capsule, box_capsule_promise());
}
TEST_CASE("box against a fixed capsule agrees with its twin", "[slow][collide]") {
  check_solids(any_capsule, Motion::fixed, any_box, box_capsule_promise());
}

}  // namespace manyworlds::test
