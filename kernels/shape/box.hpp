// Boxes: pose row, bounds, rays, distance, and as convex shapes.
#pragma once

#include "kernels/shape/convex_shape.hpp"
#include "kernels/shape/placement.hpp"
#include "kernels/shape/ray.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct BoxPose {
  static constexpr auto kKind = kernels::ShapeKind::box;
  Mat3 r;
  Vec3 p, half;
  Float margin;  // how far this box's bounds reach beyond it, m

  static MW_INLINE BoundsOf<Vec3> put(const SpatialPlacement& s);
  static MW_INLINE void load(const Real* hulls, const Real* base, const std::int32_t* o,
                             ConvexShape& s);
  static MW_INLINE Extent extent(const ConvexShape& s, Vec3 n);
  static MW_INLINE Vec3 support(const ConvexShape& s, Vec3 n);
  static MW_INLINE void feature(const ConvexShape& s, Vec3 n, Real tie, Feature& f);
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, BoxPose& b) {
  load_rows8(base, o, b.r.x.x, b.r.x.y, b.r.x.z, b.p.x, b.r.y.x, b.r.y.y, b.r.y.z, b.p.y);
  load_rows8(base + 8, o, b.r.z.x, b.r.z.y, b.r.z.z, b.p.z, b.half.x, b.half.y, b.half.z, b.margin);
}

// The row of whatever is placed as a box is.
MW_INLINE void put_box_row(const SpatialPlacement& s) {
  const Mat3& r = s.r;
  const Vec3 half = half_extents(s.constants);
  store_rows4(s.rows, s.offset, r.x.x, r.x.y, r.x.z, s.p.x);
  store_rows4(s.rows + 4, s.offset, r.y.x, r.y.y, r.y.z, s.p.y);
  store_rows4(s.rows + 8, s.offset, r.z.x, r.z.y, r.z.z, s.p.z);
  store_rows4(s.rows + 12, s.offset, half.x, half.y, half.z, s.margin);
}
// Bounds of the box of the shape's half extents.
MW_INLINE BoundsOf<Vec3> box_bounds(const SpatialPlacement& s) {
  const Mat3& r = s.r;
  const Vec3 h = half_extents(s.constants);
  return {s.p,
          {fma(abs(r.z.x), h.z, fma(abs(r.y.x), h.y, abs(r.x.x) * h.x)) + s.margin,
           fma(abs(r.z.y), h.z, fma(abs(r.y.y), h.y, abs(r.x.y) * h.x)) + s.margin,
           fma(abs(r.z.z), h.z, fma(abs(r.y.z), h.y, abs(r.x.z) * h.x)) + s.margin}};
}
MW_INLINE BoundsOf<Vec3> BoxPose::put(const SpatialPlacement& s) {
  put_box_row(s);
  return box_bounds(s);
}

MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const BoxPose& b) {
  const Vec3 place = mul_transposed(b.r, ray.from - b.p), way = mul_transposed(b.r, ray.way);
  Clip clip;
  Vec3 normal = b.r.x;
  clip_slab(clip, b.r.x, place.x, way.x, b.half.x, normal);
  clip_slab(clip, b.r.y, place.y, way.y, b.half.y, normal);
  clip_slab(clip, b.r.z, place.z, way.z, b.half.z, normal);
  return clipped(ray, clip, normal);
}

// A point in the axes of a shape, from its origin.
MW_INLINE Vec3 in_shape(const Mat3& r, Vec3 origin, Vec3 p) {
  const Vec3 d = p - origin;
  return {dot(d, r.x), dot(d, r.y), dot(d, r.z)};
}

// ---- as a convex shape -------------------------------------------------------------------------

// Of whatever is placed as a box is.
MW_INLINE void load_as_box(const Real* base, const std::int32_t* o, ConvexShape& s) {
  BoxPose box;
  load_pose(base, o, box);
  s.p = box.p, s.r = box.r, s.half = box.half, s.margin = box.margin;
}
MW_INLINE void BoxPose::load(const Real*, const Real* base, const std::int32_t* o, ConvexShape& s) {
  load_as_box(base, o, s);
}

MW_INLINE Extent BoxPose::extent(const ConvexShape& s, Vec3 n) {
  const Float reach = fma(abs(dot(s.r.x, n)), s.half.x,
                          fma(abs(dot(s.r.y, n)), s.half.y, abs(dot(s.r.z, n)) * s.half.z));
  return {-reach, reach};
}
MW_INLINE Vec3 BoxPose::support(const ConvexShape& s, Vec3 n) {
  Vec3 out = s.r.z * copysign(s.half.z, dot(s.r.z, n));
  out = fma(s.r.x, copysign(s.half.x, dot(s.r.x, n)), out);
  return fma(s.r.y, copysign(s.half.y, dot(s.r.y, n)), out);
}

// The face of a box whose outward normal is most opposed to n: its axis (0, 1, 2), the sign of
// its normal, and the two half edges that span it.
struct BoxFace {
  Float axis, sign;
  Vec3 centre;  // from the box's centre, world axes
  Vec3 edge1, edge2;
  Float half1, half2;
  Float code;  // 2 axis + (sign > 0)
};

MW_INLINE BoxFace opposed_face(const BoxPose& box, Vec3 n) {
  const Float zero(Real(0)), one(Real(1)), two(Real(2));
  // Near ties go to the earlier axis, so that rounding does not make the face flicker.
  const Float tie(Real(1e-3));
  const Float a0 = dot(n, box.r.x), a1 = dot(n, box.r.y), a2 = dot(n, box.r.z);
  Float axis = zero, best = abs(a0), along = a0;
  Mask better = best + tie < abs(a1);
  axis = select(better, one, axis), along = select(better, a1, along);
  best = select(better, abs(a1), best);
  better = best + tie < abs(a2);
  axis = select(better, two, axis), along = select(better, a2, along);
  BoxFace f;
  f.axis = axis;
  f.sign = copysign(one, -along);
  const Float axis1 = select(axis == two, zero, axis + one);
  const Float axis2 = select(axis == zero, two, axis - one);
  f.half1 = pick(axis1, box.half.x, box.half.y, box.half.z);
  f.half2 = pick(axis2, box.half.x, box.half.y, box.half.z);
  f.centre = pick(axis, box.r) * (pick(axis, box.half.x, box.half.y, box.half.z) * f.sign);
  f.edge1 = pick(axis1, box.r) * f.half1;
  f.edge2 = pick(axis2, box.r) * f.half2;
  f.code = axis + axis + select(zero < f.sign, one, zero);
  return f;
}

MW_INLINE void BoxPose::feature(const ConvexShape& s, Vec3 n, Real, Feature& f) {
  const BoxPose box{s.r, s.p, s.half, Real(0)};
  const BoxFace face = opposed_face(box, -n);
  const Vec3 u = face.edge1 * face.sign, v = face.edge2;  // counter-clockwise on either side
  f.count = 4;
  f.corner[0] = face.centre - u - v, f.corner[1] = face.centre + u - v;
  f.corner[2] = face.centre + u + v, f.corner[3] = face.centre - u + v;
  f.normal = pick(face.axis, s.r) * face.sign;
  f.along = face.edge1 * (Float(Real(1)) / max(face.half1, Real(1e-20)));
  f.code = face.code;
  f.face = mask_from_bits(kAllLanes);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
