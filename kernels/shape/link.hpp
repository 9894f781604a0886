// Links of terrains: pose row, rays, distance. Only fixed bodies have them.
#pragma once

#include "kernels/shape/capsule.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct LinkPose {  // p: its middle
  static constexpr auto kKind = kernels::ShapeKind::link;
  Vec2 p, axis;
  Float half, low, high, index;  // contacts from low to high along the axis
  Vec2 before, after;            // last normals at either end
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, LinkPose& l) {
  load_rows4(base, o, l.p.x, l.p.y, l.axis.x, l.axis.y);
  load_rows4(base + 4, o, l.half, l.low, l.high, l.index);
  load_rows4(base + 8, o, l.before.x, l.before.y, l.after.x, l.after.y);
}

// From the front only: what is behind a link is solid, and not its business.
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const LinkPose& l) {
  const Float zero(Real(0)), one(Real(1));
  const Vec2 from = ray.from - l.p, up = across(l.axis);
  const Float height = dot(up, from), fall = -dot(up, ray.way);
  const Mask toward = zero < fall;
  RayHit<Vec2> h;
  h.distance = height / select(toward, fall, one);
  h.normal = up;
  const Float place = fma(dot(ray.way, l.axis), h.distance, dot(from, l.axis));
  // A little more, so that nothing slips through where two links meet.
  const Float slack(sizeof(Real) == 4 ? Real(4e-7) : Real(1e-15));
  h.hit = toward & (zero <= height) & (abs(place) <= fma(slack, l.half + h.distance, l.half));
  return h;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
