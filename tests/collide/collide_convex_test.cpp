// Pairs with cylinders and hulls against the slow twins: random poses of each, in f32 and f64,
// between dynamic bodies and against fixed ones, with shapes on and off their body frames.
#include <catch2/catch.hpp>

#include "tests/support/pair_check.hpp"
#include "tests/support/scenes.hpp"

namespace manyworlds::test {
namespace {

constexpr int kScenes = 4;  // random sizes and offsets; 2,048 poses in all
constexpr int kPosesPerScene = 512;

Geometry any_brick(Random& r) {  // a box, as a hull
  const Vec3 half = random_box(r).half_extents;
  Hull hull;
  for (int i = 0; i < 8; ++i) {
    const Vec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    hull.vertices.push_back(half.cwiseProduct(sign));
  }
  return hull;
}

void check(ShapeMaker first, Motion first_motion, ShapeMaker second, const PairPromise& promise) {
  for (const Table& table : widest_tables()) {
    const PairResult sum = check_random_pairs({first, first_motion, second}, Space::spatial, table,
                                              promise, kScenes, kPosesPerScene, Random(20240601));
    INFO(name(table) << ": " << sum.deviations << " deviations in " << sum.poses << " poses\n"
                     << sum.report);
    CHECK(sum.deviations == 0);
    CHECK(sum.local <= sum.poses / 100);
    CHECK(sum.overlapping > sum.poses / 3);  // the poses do test something
    CHECK(sum.with_contacts >= sum.overlapping - sum.poses / 1000);
  }
}

// Faces win over what is better by half a slop and, in overlap, 5 % of the depth
// (collide_convex.cpp); a face of A over one of B by half a slop more.
PairPromise faces(int n, double twin) {
  PairPromise p = points(n);
  const double half_slop = 0.5 * test::kPairSlop;
  p.bias = half_slop / 0.95 + half_slop;
  p.bias_relative = 0.05 / 0.95;
  p.reach = 1.5;
  p.twin = twin;
  p.local_below = 0.05;  // convex_axes.cpp
  return p;
}
// On a plane the points of a face count unless another is deeper by a tenth of a slop.
PairPromise on_plane() {
  PairPromise p = points(4);
  p.bias = p.left_out = 0.1 * test::kPairSlop;
  return p;
}
constexpr double kSearched = 2e-6;

}  // namespace

TEST_CASE("cylinder-plane agrees with its twin", "[slow][collide]") {
  check(any_plane, Motion::fixed, any_cylinder, on_plane());
}
TEST_CASE("cylinder-sphere agrees with its twin", "[slow][collide]") {
  check(any_cylinder, Motion::dynamic, any_sphere, points(1));
}
TEST_CASE("sphere against a fixed cylinder agrees with its twin", "[slow][collide]") {
  check(any_cylinder, Motion::fixed, any_sphere, points(1));
}
TEST_CASE("cylinder against a fixed sphere agrees with its twin", "[slow][collide]") {
  check(any_sphere, Motion::fixed, any_cylinder, points(1));
}
TEST_CASE("cylinder-capsule agrees with its twin", "[slow][collide]") {
  check(any_cylinder, Motion::dynamic, any_capsule, faces(4, kSearched));
}
TEST_CASE("cylinder against a fixed capsule agrees with its twin", "[slow][collide]") {
  check(any_capsule, Motion::fixed, any_cylinder, faces(4, kSearched));
}
TEST_CASE("cylinder-box agrees with its twin", "[slow][collide]") {
  check(any_box, Motion::dynamic, any_cylinder, faces(4, kSearched));
}
TEST_CASE("box against a fixed cylinder agrees with its twin", "[slow][collide]") {
  check(any_cylinder, Motion::fixed, any_box, faces(4, kSearched));
}
TEST_CASE("cylinder-cylinder agrees with its twin", "[slow][collide]") {
  check(any_cylinder, Motion::dynamic, any_cylinder, faces(4, kSearched));
}
TEST_CASE("hull-plane agrees with its twin", "[slow][collide]") {
  check(any_plane, Motion::fixed, any_hull, on_plane());
}
TEST_CASE("hull-sphere agrees with its twin", "[slow][collide]") {
  check(any_hull, Motion::dynamic, any_sphere, points(1));
}
TEST_CASE("hull against a fixed sphere agrees with its twin", "[slow][collide]") {
  check(any_sphere, Motion::fixed, any_hull, points(1));
}
TEST_CASE("hull-capsule agrees with its twin", "[slow][collide]") {
  check(any_hull, Motion::dynamic, any_capsule, faces(2, 0));
}
TEST_CASE("hull against a fixed capsule agrees with its twin", "[slow][collide]") {
  check(any_capsule, Motion::fixed, any_hull, faces(2, 0));
}
TEST_CASE("hull-box agrees with its twin", "[slow][collide]") {
  check(any_hull, Motion::dynamic, any_box, faces(4, 0));
}
TEST_CASE("hull against a fixed box agrees with its twin", "[slow][collide]") {
  check(any_box, Motion::fixed, any_hull, faces(4, 0));
}
TEST_CASE("hull-cylinder agrees with its twin", "[slow][collide]") {
  check(any_hull, Motion::dynamic, any_cylinder, faces(4, kSearched));
}
TEST_CASE("hull against a fixed cylinder agrees with its twin", "[slow][collide]") {
  check(any_cylinder, Motion::fixed, any_hull, faces(4, kSearched));
}
TEST_CASE("hull-hull agrees with its twin", "[slow][collide]") {
  check(any_hull, Motion::dynamic, any_hull, faces(4, 0));
}
TEST_CASE("hull against a fixed hull agrees with its twin", "[slow][collide]") {
  check(any_hull, Motion::fixed, any_hull, faces(4, 0));
}
TEST_CASE("a box described as a hull against the same agrees with its twin", "[slow][collide]") {
  check(any_brick, Motion::dynamic, any_brick, faces(4, 0));
}

}  // namespace manyworlds::test
