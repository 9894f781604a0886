// Capsules, in the plane and in space: pose row, bounds, rays, distance, corners, and as convex
// shapes.
#pragma once

#include "kernels/shape/convex_shape.hpp"
#include "kernels/shape/corners.hpp"
#include "kernels/shape/placement.hpp"
#include "kernels/shape/ray.hpp"
#include "kernels/shape/tangent.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class Vec>
struct CapsulePose {
  static constexpr auto kKind = kernels::ShapeKind::capsule;
  Vec p, axis;
  Float radius, half;  // half length without the round ends

  static MW_INLINE BoundsOf<Vec3> put(const SpatialPlacement& s);
  static MW_INLINE BoundsOf<Vec2> put(const PlanarPlacement& s);
  static MW_INLINE void load(const Real* hulls, const Real* base, const std::int32_t* o,
                             ConvexShape& s);
  static MW_INLINE Extent extent(const ConvexShape& s, Vec3 n) {
    const Float reach = abs(dot(s.r.z, n)) * s.half.z;
    return {-reach, reach};
  }
  static MW_INLINE Vec3 support(const ConvexShape& s, Vec3 n) {
    return s.r.z * copysign(s.half.z, dot(s.r.z, n));
  }
  static MW_INLINE void feature(const ConvexShape& s, Vec3 n, Real, Feature& f) {
    line_feature(s, n, f);
  }
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, CapsulePose<Vec3>& c) {
  load_rows8(base, o, c.p.x, c.p.y, c.p.z, c.radius, c.axis.x, c.axis.y, c.axis.z, c.half);
}
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, CapsulePose<Vec2>& c) {
  Float unused;
  load_rows4(base, o, c.p.x, c.p.y, unused, c.radius);
  load_rows4(base + 4, o, c.axis.x, c.axis.y, unused, c.half);
}

template <class Vec>
MW_INLINE BoundsOf<Vec3> CapsulePose<Vec>::put(const SpatialPlacement& s) {
  const Vec3 axis = s.r.z;
  const Float half(s.constants.half[0]), reach = s.margin + Float(s.constants.radius);
  store_rows4(s.rows, s.offset, s.p.x, s.p.y, s.p.z, s.constants.radius);
  store_rows4(s.rows + 4, s.offset, axis.x, axis.y, axis.z, half);
  return {s.p,
          {fma(abs(axis.x), half, reach), fma(abs(axis.y), half, reach),
           fma(abs(axis.z), half, reach)}};
}
template <class Vec>
MW_INLINE BoundsOf<Vec2> CapsulePose<Vec>::put(const PlanarPlacement& s) {
  const Rot2 q = s.r;
  const Float half(s.constants.half[0]), reach = s.margin + Float(s.constants.radius);
  store_rows4(s.rows, s.offset, s.p.x, s.p.y, Real(0), s.constants.radius);
  store_rows4(s.rows + 4, s.offset, -q.s, q.c, Real(0), half);
  return {s.p, {fma(abs(q.s), half, reach), fma(abs(q.c), half, reach)}};
}

template <class Vec>
MW_INLINE void CapsulePose<Vec>::load(const Real*, const Real* base, const std::int32_t* o,
                                      ConvexShape& s) {
  CapsulePose<Vec3> pose;
  load_pose(base, o, pose);
  set_round(s, pose.p, pose.axis, pose.radius, pose.half);
}

// The side of a capsule: in space a cylinder, in the plane the two lines along it. `to`: its middle
// from the ray's origin.
MW_INLINE RayHit<Vec3> cast_side(const RayOf<Vec3>& ray, Vec3 to, const CapsulePose<Vec3>& c) {
  const Float zero(Real(0)), one(Real(1));
  const Float slope = dot(ray.way, c.axis);
  const Vec3 across_way = fnma(c.axis, slope, ray.way),
             across_to = fnma(c.axis, dot(to, c.axis), to);
  const Float a = dot(across_way, across_way);
  const Mask crosses = Float(Real(1e-12)) < a;
  const Float inv = one / select(crosses, a, one);
  const Float nearest = dot(across_to, across_way) * inv;
  const Vec3 aside = fnma(across_way, nearest, across_to);
  const Float rest = fnma(c.radius, c.radius, dot(aside, aside));
  RayHit<Vec3> h;
  h.distance = nearest - sqrt(max(-rest, zero) * inv);
  const Vec3 out = fma(across_way, h.distance, -across_to);
  const Float length2 = dot(out, out);
  h.normal = out * (one / sqrt(select(zero < length2, length2, one)));
  const Float place = fma(slope, h.distance, -dot(to, c.axis));
  h.hit = crosses & (rest <= zero) & (zero <= h.distance) & (abs(place) <= c.half);
  return h;
}
MW_INLINE RayHit<Vec2> cast_side(const RayOf<Vec2>& ray, Vec2 to, const CapsulePose<Vec2>& c) {
  const Float zero(Real(0)), one(Real(1));
  const Vec2 up = across(c.axis);
  const Float above = -dot(up, to), rise = dot(up, ray.way);
  const Float side = copysign(one, above), fall = -(side * rise);
  const Mask toward = zero < fall;
  RayHit<Vec2> h;
  h.distance = (abs(above) - c.radius) / select(toward, fall, one);
  h.normal = up * side;
  const Float place = fma(dot(ray.way, c.axis), h.distance, -dot(to, c.axis));
  h.hit = toward & (zero <= h.distance) & (abs(place) <= c.half);
  return h;
}
template <class Vec>
MW_INLINE RayHit<Vec> cast(const RayOf<Vec>& ray, const CapsulePose<Vec>& c) {
  const Vec to = c.p - ray.from, end = c.axis * c.half;
  const RayHit<Vec> ends =
      nearer(cast_round(ray, to + end, c.radius), cast_round(ray, to - end, c.radius));
  const Vec out = to - c.axis * clamp(dot(to, c.axis), -c.half, c.half);
  return begin_inside(ray, dot(out, out) <= c.radius * c.radius,
                      nearer(ends, cast_side(ray, to, c)));
}

// The thinnest polygon, of two corners and two edges that look to either side, with a radius around
// it.
MW_INLINE Corners<2> load_corners(const CapsulePose<Vec2>& c) {
  const Vec2 end = c.axis * c.half, left = across(c.axis);
  return {{-end, end}, {-left, left}};
}
MW_INLINE Float radius_of(const CapsulePose<Vec2>& c) { return c.radius; }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
