// Plane against box and rectangle: the corners of the face that looks at the plane most.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/shape/shapes.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Stored impulses go to points that moved less than this share of the smaller face extent.
inline constexpr Real kMatchShare = Real(0.12);

MW_INLINE Float match_distance2(Float extent) { return square(extent * Float(kMatchShare)); }

template <class S>
struct PlaneBox {
  using A = PlanePose;
  using B = BoxPose;
  static constexpr int kPoints = 4;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 4>& m) {
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
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 2>& m) {
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
