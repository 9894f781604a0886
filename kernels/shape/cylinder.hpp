// Cylinders about z: pose row, bounds, rays, distance, and as convex shapes.
#pragma once

#include "kernels/shape/box.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct CylinderPose {
  static constexpr auto kKind = kernels::ShapeKind::cylinder;
  Mat3 r;
  Vec3 p;
  Float radius, half;

  static MW_INLINE BoundsOf<Vec3> put(const SpatialPlacement& s);
  static MW_INLINE void load(const Real*, const Real* base, const std::int32_t* o, ConvexShape& s) {
    load_as_box(base, o, s);
  }
  static MW_INLINE Extent extent(const ConvexShape& s, Vec3 n);
  static MW_INLINE Vec3 support(const ConvexShape& s, Vec3 n);
  static MW_INLINE void feature(const ConvexShape& s, Vec3 n, Real tie, Feature& f);
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, CylinderPose& c) {
  BoxPose box;
  load_pose(base, o, box);
  c = {box.r, box.p, box.half.x, box.half.z};
}

MW_INLINE BoundsOf<Vec3> CylinderPose::put(const SpatialPlacement& s) {
  put_box_row(s);
  const Float hx(s.constants.half[0]), hz(s.constants.half[2]);
  const auto half_of = [&](Float along) {
    const Float rim2 = max(fnma(along, along, Float(Real(1))), Real(0));
    return fma(sqrt(rim2), hx, fma(abs(along), hz, s.margin));
  };
  return {s.p, {half_of(s.r.z.x), half_of(s.r.z.y), half_of(s.r.z.z)}};
}

// Between its caps and within its round side.
MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const CylinderPose& c) {
  const Float zero(Real(0)), one(Real(1)), far(kRayFar);
  const Vec3 from = ray.from - c.p;
  const Float place = dot(c.r.z, from), slope = dot(c.r.z, ray.way);
  const Vec3 from_axis = fnma(c.r.z, place, from), way = fnma(c.r.z, slope, ray.way);
  Clip clip;
  Vec3 normal = c.r.z;
  clip_slab(clip, c.r.z, place, slope, c.half, normal);
  const Float a = dot(way, way);
  const Mask crosses = Float(Real(1e-12)) < a;
  const Float inv = one / select(crosses, a, one), nearest = -(dot(from_axis, way) * inv);
  const Vec3 aside = fma(way, nearest, from_axis);
  const Float rest = fnma(c.radius, c.radius, dot(aside, aside));
  const Float half = sqrt(max(-rest, zero) * inv);
  const Mask misses =
      zero < select(crosses, rest, fnma(c.radius, c.radius, dot(from_axis, from_axis)));
  const Float in = select(misses, far, select(crosses, nearest - half, -far));
  const Float out = select(crosses, nearest + half, far);
  const Mask last = clip.enter < in;
  const Vec3 rim = fma(way, in, from_axis);
  normal = select(last & crosses & !misses, rim * (one / c.radius), normal);
  clip.enter = max(in, clip.enter);
  clip.leave = min(out, clip.leave);
  return clipped(ray, clip, normal);
}

// ---- as a convex shape -------------------------------------------------------------------------

// How far and where to n points out of the axis of a cylinder. In the cap's own axes, so that it
// lies in the cap however little that is.
struct Outward {
  Float length;
  Vec3 way;  // unit; any where there is no length
};
MW_INLINE Outward out_of_axis(const ConvexShape& s, Vec3 n) {
  const Float one(Real(1)), x = dot(s.r.x, n), y = dot(s.r.y, n);
  const Float l2 = fma(x, x, y * y);
  const Mask real = Float(sizeof(Real) == 4 ? Real(1e-24) : Real(1e-40)) < l2;
  const Float length = sqrt(l2), inv = one / select(real, length, one);
  return {length, select(real, fma(s.r.x, x * inv, s.r.y * (y * inv)), s.r.x)};
}

MW_INLINE Extent CylinderPose::extent(const ConvexShape& s, Vec3 n) {
  const Float reach = fma(out_of_axis(s, n).length, s.half.x, abs(dot(s.r.z, n)) * s.half.z);
  return {-reach, reach};
}
MW_INLINE Vec3 CylinderPose::support(const ConvexShape& s, Vec3 n) {
  return fma(out_of_axis(s, n).way, s.half.x, s.r.z * copysign(s.half.z, dot(s.r.z, n)));
}

// The side of a cylinder is a line, a cap four points of its rim, always the same ones.
MW_INLINE void CylinderPose::feature(const ConvexShape& s, Vec3 n, Real, Feature& f) {
  const Float zero(Real(0)), one(Real(1)), along = dot(s.r.z, n);
  const Vec3 lowest = out_of_axis(s, n).way;
  const Mask cap = Float(Real(0.7)) < abs(along);
  const Float sign = copysign(one, along);
  const Vec3 end = s.r.z * s.half.z, top = end * sign, side = lowest * s.half.x;
  const Vec3 x = s.r.x * s.half.x, y = s.r.y * (s.half.x * sign);
  f.count = all(!cap) ? 2 : 4;
  f.corner[0] = select(cap, top + x, side - end);
  f.corner[1] = select(cap, top + y, side + end);
  f.corner[2] = select(cap, top - x, side + end);
  f.corner[3] = select(cap, top - y, side + end);
  f.normal = select(cap, s.r.z * sign, lowest);
  f.along = select(cap, s.r.x, s.r.z);
  f.code = select(cap, select(zero < along, one, Float(Real(2))), zero);
  f.face = cap;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
