// Random poses of one pair of shapes, seen by Batch::contacts and judged by the slow twins.
#pragma once

#include <string>

#include "manyworlds/batch.hpp"
#include "tests/support/random.hpp"
#include "tests/support/solid.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

inline constexpr double kPairSlop = 0.005;  // m, of the scenes that are checked

// What a kernel promises about the deepest point of an overlapping pair.
struct PairPromise {
  // The normal may be any whose penetration is within bias + bias_relative x depth of the
  // smallest one (box-box prefers faces); 0 where the smallest is found exactly.
  double bias = 0;  // m
  double bias_relative = 0;
  // Separating axes see at most the distance of disjoint shapes, so that contacts may begin
  // farther away than the margin by this factor.
  double reach = 1;
  int max_points = 1;
  // Deeper than this the normal may be one that only its neighbours are worse than; 0: never. Then
  // PairResult::local counts it.
  double local_below = 0;  // m
  double left_out = 0;     // m, how much deeper a point may be that is left out
  double twin = 0;         // m, what the twin's own answer may be wrong by
};
// With up to n points, and otherwise exact.
inline PairPromise points(int n) {
  PairPromise p;
  p.max_points = n;
  return p;
}

// Counts, and the first few deviations in words with every number needed to see them again.
struct PairResult {
  int poses = 0;
  int overlapping = 0;
  int with_contacts = 0;
  int normals_checked = 0;  // against exact_normal()
  int local = 0;
  int deviations = 0;
  std::string report;
};

// The scene has two bodies with one shape each; every dynamic one gets random poses, mostly close
// to touching. Planar scenes get planar poses.
PairResult check_pair(const Scene& scene, const Table& table, const PairPromise& promise, int poses,
                      Random& random);
// Of all bodies of all worlds, in the order of the scene.
void write_poses(Batch& batch, const std::vector<std::vector<Pose>>& poses);

// Random shapes for check_pair, 0.1 to 0.6 m in half extent.
Polygon random_polygon(Random& random, int vertices);
Box random_box(Random& random);
Capsule random_capsule(Random& random);
Cylinder random_cylinder(Random& random);
Hull random_hull(Random& random, int vertices);
// A body with this shape, placed off its body frame by a random pose when `offset` is set.
Body random_body(Geometry geometry, Motion motion, bool offset, Space space, Random& random);

using ShapeMaker = Geometry (*)(Random&);
inline Geometry any_sphere(Random& r) { return Sphere{r.uniform(0.1, 0.6)}; }
inline Geometry any_box(Random& r) { return random_box(r); }
inline Geometry any_capsule(Random& r) { return random_capsule(r); }
inline Geometry any_cylinder(Random& r) { return random_cylinder(r); }
inline Geometry any_hull(Random& r) {
  return random_hull(r, 4 + static_cast<int>(r.uniform(0, 9)));
}
inline Geometry any_plane(Random& r) { return Plane{r.direction(), r.uniform(-0.5, 0.5)}; }
struct RandomPair {
  ShapeMaker first;
  Motion first_motion;
  ShapeMaker second;  // of a dynamic body
};
// check_pair over scenes of random shapes: every other one off its body frame, and in both orders.
PairResult check_random_pairs(const RandomPair& pair, Space space, const Table& table,
                              const PairPromise& promise, int scenes, int poses, Random random);

}  // namespace manyworlds::test
