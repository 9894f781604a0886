// Plane against box and rectangle: the corners of the face that looks at the plane most.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/shape/poses.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Stored impulses go to points that moved less than this share of the smaller face extent.
inline constexpr Real kMatchShare = Real(0.12);

MW_INLINE Float match_distance2(Float extent) { return square(extent * Float(kMatchShare)); }

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

template <class S>
struct PlaneBox {
  using A = PlanePose;
  using B = BoxPose;
  static constexpr int kPoints = 4;
  static MW_INLINE void collide(const Tables&, const A& a, const B& b, Float, Manifold<S, 4>& m) {
    const BoxFace f = opposed_face(b, a.normal);
    const Vec3 corner[4] = {f.centre + f.edge1 + f.edge2, f.centre - f.edge1 + f.edge2,
                            f.centre - f.edge1 - f.edge2, f.centre + f.edge1 - f.edge2};
    const Float x[4] = {f.half1, -f.half1, -f.half1, f.half1};
    const Float y[4] = {f.half2, f.half2, -f.half2, -f.half2};
    const Float height = dot(a.normal, b.p) - a.offset;
    m.normal = a.normal;
    m.tangent = a.tangent;
    for (int i = 0; i < 4; ++i) {
      m.separation[i] = height + dot(a.normal, corner[i]);
      m.point_b[i] = fma(a.normal, min(m.separation[i], Real(0)) * Float(Real(-0.5)), corner[i]);
      m.point_a[i] = m.point_b[i];
      m.feature_x[i] = x[i];
      m.feature_y[i] = y[i];
      m.valid[i] = mask_from_bits(kAllLanes);
    }
    m.code = f.code;
    m.match_distance2 = match_distance2(min(f.half1, f.half2));
  }
};

template <class S>
struct PlaneRectangle {
  using A = PlanePose;
  using B = RectanglePose;
  static constexpr int kPoints = 2;
  static MW_INLINE void collide(const Tables&, const A& a, const B& b, Float, Manifold<S, 2>& m) {
    const Float zero(Real(0)), one(Real(1)), tie(Real(1e-3));
    const Vec2 n{a.normal.x, a.normal.y};
    const Vec2 local = rotate_inverse(b.q, n);
    const Mask use_y = abs(local.x) + tie < abs(local.y);
    const Float sign = copysign(one, -select(use_y, local.y, local.x));
    const Vec2 ux = rotate(b.q, {one, zero}), uy{-ux.y, ux.x};
    const Float half_n = select(use_y, b.half.y, b.half.x);
    const Float half_t = select(use_y, b.half.x, b.half.y);
    const Vec2 centre = select(use_y, uy, ux) * (half_n * sign);
    const Vec2 edge = select(use_y, ux, uy) * half_t;
    const Float height = dot(n, b.p) - a.offset;
    const Vec2 corner[2] = {centre - edge, centre + edge};
    m.normal = n;
    for (int i = 0; i < 2; ++i) {
      m.separation[i] = height + dot(n, corner[i]);
      m.point_b[i] = fma(n, min(m.separation[i], Real(0)) * Float(Real(-0.5)), corner[i]);
      m.point_a[i] = m.point_b[i];
      m.feature_x[i] = i == 0 ? -half_t : half_t;
      m.feature_y[i] = zero;
      m.valid[i] = mask_from_bits(kAllLanes);
    }
    m.code = select(use_y, Float(Real(2)), zero) + select(zero < sign, one, zero);
    m.match_distance2 = match_distance2(half_t);
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
