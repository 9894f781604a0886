// Circles: pose row, bounds, rays, distance.
#pragma once

#include "kernels/shape/placement.hpp"
#include "kernels/shape/ray.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct CirclePose {
  static constexpr auto kKind = kernels::ShapeKind::circle;
  Vec2 p;
  Float radius;

  static MW_INLINE BoundsOf<Vec2> put(const PlanarPlacement& s) {
    store_rows4(s.rows, s.offset, s.p.x, s.p.y, s.constants.radius, Real(0));
    const Float reach = s.margin + Float(s.constants.radius);
    return {s.p, {reach, reach}};
  }
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, CirclePose& c) {
  Float unused;
  load_rows4(base, o, c.p.x, c.p.y, c.radius, unused);
}

MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const CirclePose& c) {
  return cast_round(ray, c.p - ray.from, c.radius);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
