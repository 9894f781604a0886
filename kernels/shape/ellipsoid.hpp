// Ellipsoids: pose row, bounds, rays, distance, and as convex shapes. They are round all over, so
// they touch anything at one point.
#pragma once

#include "kernels/shape/box.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct EllipsoidPose {
  static constexpr auto kKind = kernels::ShapeKind::ellipsoid;
  Mat3 r;
  Vec3 p, radii;

  static MW_INLINE BoundsOf<Vec3> put(const SpatialPlacement& s);
  static MW_INLINE void load(const Real*, const Real* base, const std::int32_t* o, ConvexShape& s) {
    load_as_box(base, o, s);
  }
  static MW_INLINE Extent extent(const ConvexShape& s, Vec3 n);
  static MW_INLINE Vec3 support(const ConvexShape& s, Vec3 n);
  // The point itself: there is no face, and no edge.
  static MW_INLINE void feature(const ConvexShape& s, Vec3 n, Real, Feature& f) {
    f.count = 2;
    f.corner[0] = f.corner[1] = support(s, n);
    f.normal = n;
    f.along = s.r.x;
    f.code = Real(0);
    f.face = mask_from_bits(0);
  }
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, EllipsoidPose& e) {
  BoxPose box;
  load_pose(base, o, box);
  e = {box.r, box.p, box.half};
}

// A unit direction in the shape's axes, times the radii: as long as the shape reaches along it.
MW_INLINE Vec3 scaled(const Mat3& r, Vec3 radii, Vec3 n) {
  return times(mul_transposed(r, n), radii);
}

MW_INLINE BoundsOf<Vec3> EllipsoidPose::put(const SpatialPlacement& s) {
  put_box_row(s);
  const Vec3 radii = half_extents(s.constants);
  const auto reach = [&](Float x, Float y, Float z) {
    const Vec3 v = times({x, y, z}, radii);
    return sqrt(dot(v, v)) + s.margin;
  };
  return {s.p,
          {reach(s.r.x.x, s.r.y.x, s.r.z.x), reach(s.r.x.y, s.r.y.y, s.r.z.y),
           reach(s.r.x.z, s.r.y.z, s.r.z.z)}};
}

// Where the radii are 1 it is a unit ball, and the ray keeps its lengths.
MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const EllipsoidPose& e) {
  const Float zero(Real(0)), one(Real(1));
  const Vec3 inverse{one / e.radii.x, one / e.radii.y, one / e.radii.z};
  const Vec3 from = times(mul_transposed(e.r, ray.from - e.p), inverse);
  const Vec3 way = times(mul_transposed(e.r, ray.way), inverse);
  const Float inv = one / dot(way, way), nearest = -(dot(from, way) * inv);
  const Vec3 aside = fma(way, nearest, from);
  const Float rest = dot(aside, aside) - one;
  RayHit<Vec3> h;
  h.distance = nearest - sqrt(max(-rest, zero) * inv);
  h.hit = (rest <= zero) & (zero <= h.distance);
  const Vec3 out = times(fma(way, h.distance, from), inverse);
  h.normal = mul(e.r, out * (one / sqrt(max(dot(out, out), Real(1e-30)))));
  return begin_inside(ray, dot(from, from) <= one, h);
}

// ---- as a convex shape -------------------------------------------------------------------------

MW_INLINE Extent EllipsoidPose::extent(const ConvexShape& s, Vec3 n) {
  const Vec3 v = scaled(s.r, s.half, n);
  const Float reach = sqrt(dot(v, v));
  return {-reach, reach};
}
MW_INLINE Vec3 EllipsoidPose::support(const ConvexShape& s, Vec3 n) {
  const Vec3 v = scaled(s.r, s.half, n);
  const Float inv = Float(Real(1)) / sqrt(max(dot(v, v), Real(1e-30)));
  return mul(s.r, times(v, s.half) * inv);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
