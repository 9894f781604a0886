// Queries on single shapes, without a Batch: overlap, distance, contact manifold and ray cast. In
// double precision; manifolds and rays are in float32 if the library has no float64 kernels.
//
// A pose is that of the body that the shape belongs to. Shape::position and rotation apply too;
// material, filter and density are ignored. Planar or spatial follows from the shapes; `space`
// decides if both are capsules, which exist in both. All functions throw SceneError for a shape or
// pose that validate() rejects, with its location ("body 0 'a', shape 0: ..."), and
// std::invalid_argument for a pair without a meaning (two planes).
//
// Each call takes a few microseconds; manifold() takes some hundreds, since it builds a world.
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

// Distance and nearest points of two shapes.
struct Separation {
  double distance = 0;          // m; if they overlap, minus the shortest separating translation
  Vec3 point_a = Vec3::Zero();  // m, world: the nearest points of A and B, or the deepest points
  Vec3 point_b = Vec3::Zero();  // if they overlap
  Vec3 normal = Vec3::UnitX();  // unit, from A to B: point_b = point_a + distance normal
};

// Closed forms over the features of both shapes. A terrain counts as its line, without the solid
// behind it.
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
// Contact points of the step's collision kernels with a separation of at most `margin` m. At least
// one of the shapes must be able to move.
std::vector<ManifoldPoint> manifold(const Shape& a, const Pose& pose_a, const Shape& b,
                                    const Pose& pose_b, double margin = 0,
                                    std::optional<Space> space = std::nullopt);

// The hit of a ray, as an observed ray returns it; empty if the ray misses. The ray's body and mask
// are ignored. Body and shape of the hit are 0.
std::optional<RayHit> ray_cast(const Shape& shape, const Pose& pose, const Ray& ray,
                               std::optional<Space> space = std::nullopt);

// The geometry with another size (Parameter::size); uses the first values of `size` that apply.
Geometry resized(Geometry geometry, const Vec3& size);

}  // namespace manyworlds
