// Box against sphere and rectangle against circle: the nearest point of the box's surface to the
// centre; from inside, the nearest face.
#pragma once

#include "kernels/collide/round_pairs.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct BoxSphere {
  using A = BoxPose;
  using B = SpherePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    const Float zero(Real(0)), one(Real(1));
    const Vec3 d = b.p - a.p;
    const Vec3 local = mul_transposed(a.r, d);
    const Vec3 nearest{clamp(local.x, -a.half.x, a.half.x), clamp(local.y, -a.half.y, a.half.y),
                       clamp(local.z, -a.half.z, a.half.z)};
    const Vec3 out = local - nearest;
    const Float d2 = dot(out, out);
    const Mask outside = Float(kTinyDistance2) < d2;
    const Float length = sqrt(d2);
    const Float inv = one / select(outside, length, one);
    // Inside: depth below each face; the shallowest wins, x before y before z.
    const Float gx = abs(local.x) - a.half.x, gy = abs(local.y) - a.half.y,
                gz = abs(local.z) - a.half.z;
    const Mask y_wins = gx < gy;
    const Mask z_wins = max(gx, gy) < gz;
    const Vec3 face = select(z_wins, Vec3{zero, zero, copysign(one, local.z)},
                             select(y_wins, Vec3{zero, copysign(one, local.y), zero},
                                    Vec3{copysign(one, local.x), zero, zero}));
    const Vec3 n_local = select(outside, out * inv, face);
    const Float distance = select(outside, length, max(max(gx, gy), gz));
    const Vec3 n = mul(a.r, n_local);
    const Float separation = distance - b.radius;
    m.normal = n;
    m.tangent = any_tangent(n);
    m.separation[0] = separation;
    m.point_b[0] = n * -fma(min(separation, zero), Real(0.5), b.radius);
    m.point_a[0] = fma(n, -max(separation, zero), m.point_b[0] + d);
    m.feature_x[0] = m.feature_y[0] = zero;
    m.code = zero;
    m.match_distance2 = zero;
    m.valid[0] = mask_from_bits(kAllLanes);
  }
};

template <class S>
struct RectangleCircle {
  using A = RectanglePose;
  using B = CirclePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    const Float zero(Real(0)), one(Real(1));
    const Vec2 d = b.p - a.p;
    const Vec2 local = rotate_inverse(a.q, d);
    const Vec2 nearest{clamp(local.x, -a.half.x, a.half.x), clamp(local.y, -a.half.y, a.half.y)};
    const Vec2 out = local - nearest;
    const Float d2 = dot(out, out);
    const Mask outside = Float(kTinyDistance2) < d2;
    const Float length = sqrt(d2);
    const Float inv = one / select(outside, length, one);
    const Float gx = abs(local.x) - a.half.x, gy = abs(local.y) - a.half.y;
    const Vec2 face =
        select(gx < gy, Vec2{zero, copysign(one, local.y)}, Vec2{copysign(one, local.x), zero});
    const Vec2 n = rotate(a.q, select(outside, out * inv, face));
    const Float separation = select(outside, length, max(gx, gy)) - b.radius;
    m.normal = n;
    m.separation[0] = separation;
    m.point_b[0] = n * -fma(min(separation, zero), Real(0.5), b.radius);
    m.point_a[0] = fma(n, -max(separation, zero), m.point_b[0] + d);
    m.feature_x[0] = m.feature_y[0] = zero;
    m.code = zero;
    m.match_distance2 = zero;
    m.valid[0] = mask_from_bits(kAllLanes);
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
