// Planes and half-planes: pose row, rays. Only fixed bodies have them.
#pragma once

#include "kernels/data/shape_kinds.hpp"
#include "kernels/shape/ray.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct PlanePose {  // origin at the point of the plane nearest to the world's origin
  static constexpr auto kKind = kernels::ShapeKind::plane;
  Vec3 normal, tangent;
  Float offset;
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, PlanePose& p) {
  Float unused;
  load_rows8(base, o, p.normal.x, p.normal.y, p.normal.z, p.offset, p.tangent.x, p.tangent.y,
             p.tangent.z, unused);
}

MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const PlanePose& p) {
  return cast_half_space(ray, p.normal, dot(p.normal, ray.from) - p.offset);
}
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const PlanePose& p) {
  const Vec2 normal{p.normal.x, p.normal.y};
  return cast_half_space(ray, normal, dot(normal, ray.from) - p.offset);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
