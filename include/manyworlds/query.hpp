// Queries on single shapes, outside of any Batch: do two shapes overlap, how far are they apart,
// where would they touch, where does a ray hit. In double precision (manifolds and rays in float32
// when the library was built without float64 kernels).
//
// `pose` places the body that the shape belongs to; Shape::position and rotation count as well, its
// material, filter and density do not. A shape that is neither of space nor of the plane alone (a
// capsule) takes the other's; of two such `space` decides. All throw SceneError for a shape or pose
// that validate() would not accept, with its place ("body 0 'a', shape 0: ..."), and
// std::invalid_argument for a pair that makes no sense (two planes).
//
// A few microseconds each, manifold() some hundreds: it sets up a world of two bodies.
#pragma once

#include <optional>
#include <vector>

#include "manyworlds/observe.hpp"
#include "manyworlds/plan.hpp"

namespace manyworlds {

struct Pose {
  Vec3 position = Vec3::Zero();      // m, of the body frame in the world
  Quat rotation = Quat::Identity();  // need not be unit
};

// How two shapes lie to each other.
struct Separation {
  double distance = 0;          // m; negative: the least way that takes them apart, times -1
  Vec3 point_a = Vec3::Zero();  // m, world: the nearest points of A and B, when they overlap the
  Vec3 point_b = Vec3::Zero();  // deepest ones
  Vec3 normal = Vec3::UnitX();  // unit, from A to B: point_b = point_a + distance normal
};

// Closed forms over the features of both shapes. A terrain is its line: what is wholly behind it is
// apart from it.
Separation distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
                    std::optional<Space> space = std::nullopt);
bool overlap(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b,
             std::optional<Space> space = std::nullopt);  // distance <= 0

struct ManifoldPoint {
  Vec3 normal = Vec3::UnitX();  // unit, from A to B
  Vec3 point = Vec3::Zero();    // m, world, half way between the surfaces
  double separation = 0;        // m, negative when the shapes overlap there
  int feature = 0;              // which features touch; equal ids persist in motion
};
// The points in which the step would let the shapes touch, no farther apart than `margin` m: found
// by its own collision kernels. One of the shapes at least must be able to move.
std::vector<ManifoldPoint> manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                    const Pose& pose_b, double margin = 0,
                                    std::optional<Space> space = std::nullopt);

// Where a ray of the world hits the shape, as observed rays do; nothing where it misses. Its body
// and mask do not count. Body and shape of the hit are 0.
std::optional<RayHit> ray_cast(const Shape& shape, const Pose& pose, const Ray& ray,
                               std::optional<Space> space = std::nullopt);

// The geometry with another size (Parameter::size), of which it takes as many numbers as it has.
Geometry resized(Geometry geometry, const Vec3& size);

}  // namespace manyworlds
