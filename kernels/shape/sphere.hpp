// Spheres: pose row, bounds, rays, distance, and as convex shapes.
#pragma once

#include "kernels/shape/convex_shape.hpp"
#include "kernels/shape/placement.hpp"
#include "kernels/shape/ray.hpp"
#include "kernels/shape/tangent.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct SpherePose {
  static constexpr auto kKind = kernels::ShapeKind::sphere;
  Vec3 p;
  Float radius;

  static MW_INLINE BoundsOf<Vec3> put(const SpatialPlacement& s);
  static MW_INLINE void load(const Real* hulls, const Real* base, const std::int32_t* o,
                             ConvexShape& s);
  static MW_INLINE Extent extent(const ConvexShape&, Vec3) { return {Real(0), Real(0)}; }
  static MW_INLINE Vec3 support(const ConvexShape&, Vec3) { return {Real(0), Real(0), Real(0)}; }
  static MW_INLINE void feature(const ConvexShape& s, Vec3 n, Real, Feature& f) {
    line_feature(s, n, f);
  }
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, SpherePose& s) {
  load_rows4(base, o, s.p.x, s.p.y, s.p.z, s.radius);
}

MW_INLINE BoundsOf<Vec3> SpherePose::put(const SpatialPlacement& s) {
  store_rows4(s.rows, s.offset, s.p.x, s.p.y, s.p.z, s.constants.radius);
  const Float reach = s.margin + Float(s.constants.radius);
  return {s.p, {reach, reach, reach}};
}

MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const SpherePose& s) {
  return cast_round(ray, s.p - ray.from, s.radius);
}

MW_INLINE void SpherePose::load(const Real*, const Real* base, const std::int32_t* o,
                                ConvexShape& s) {
  SpherePose pose;
  load_pose(base, o, pose);
  set_round(s, pose.p, {Real(0), Real(0), Real(1)}, pose.radius, Real(0));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
