// Small symmetric systems, and angles.
#pragma once

#include "kernels/lane/algebra.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct Sym2 {  // symmetric
  Float xx, xy, yy;
};
MW_INLINE Vec2 mul(const Sym2& s, Vec2 v) {
  return {fma(s.xy, v.y, s.xx * v.x), fma(s.yy, v.y, s.xy * v.x)};
}
MW_INLINE Sym2 select(Mask m, const Sym2& a, const Sym2& b) {
  return {select(m, a.xx, b.xx), select(m, a.xy, b.xy), select(m, a.yy, b.yy)};
}

// 1 / a, and 0 for a that is not positive: rows that move nothing get no impulse.
MW_INLINE Float inverse_or_zero(Float a) {
  const Float zero(Real(0));
  const Mask positive = zero < a;
  return select(positive, Float(Real(1)) / select(positive, a, Real(1)), zero);
}

// Inverses of positive definite matrices, of which they may be very large or small: they are
// divided by their trace first. Zero where a matrix is singular.
MW_INLINE Sym2 inverse(const Sym2& k) {
  const Float s = inverse_or_zero(k.xx + k.yy);
  const Float xx = k.xx * s, xy = k.xy * s, yy = k.yy * s;
  const Float f = s * inverse_or_zero(fms(xx, yy, xy * xy));
  return {yy * f, -(xy * f), xx * f};
}
MW_INLINE Sym3 inverse(const Sym3& k) {
  const Float s = inverse_or_zero(k.xx + k.yy + k.zz);
  const Sym3 a{k.xx * s, k.xy * s, k.xz * s, k.yy * s, k.yz * s, k.zz * s};
  const Float xx = fms(a.yy, a.zz, a.yz * a.yz), xy = fms(a.xz, a.yz, a.xy * a.zz),
              xz = fms(a.xy, a.yz, a.xz * a.yy);
  const Float f = s * inverse_or_zero(fma(a.xz, xz, fma(a.xy, xy, a.xx * xx)));
  return {xx * f,
          xy * f,
          xz * f,
          fms(a.xx, a.zz, a.xz * a.xz) * f,
          fms(a.xy, a.xz, a.xx * a.yz) * f,
          fms(a.xx, a.yy, a.xy * a.xy) * f};
}

// Arc tangent of t in [0, tan(pi / 8)]: the float polynomial and the double rational of the Cephes
// library (Moshier 1989), good to an ulp or two.
MW_INLINE Float small_arc_tangent(Float t) {
  const Float z = t * t;
  if constexpr (sizeof(Real) == 4) {
    const Float p =
        fma(fma(fma(z, Real(8.05374449538e-2), Real(-1.38776856032e-1)), z, Real(1.99777106478e-1)),
            z, Real(-3.33329491539e-1));
    return fma(p * z, t, t);
  } else {
    const Float p =
        fma(fma(fma(fma(z, Real(-8.750608600031904122785e-1), Real(-1.615753718733365076637e1)), z,
                    Real(-7.500855792314704667340e1)),
                z, Real(-1.228866684490136173410e2)),
            z, Real(-6.485021904942025371773e1));
    const Float q =
        fma(fma(fma(fma(z + Real(2.485846490142306297962e1), z, Real(1.650270098316988542046e2)), z,
                    Real(4.328810604912902668951e2)),
                z, Real(4.853903996359136964868e2)),
            z, Real(1.945506571482613964425e2));
    return fma(p * z / q, t, t);
  }
}

// The angle of (x, y), -pi to pi; 0 for (0, 0).
MW_INLINE Float arc_tangent(Float y, Float x) {
  const Float ax = abs(x), ay = abs(y), zero(Real(0));
  const Float small = min(ax, ay), large = max(ax, ay);
  // atan(s / l) for s <= l; beyond tan(pi / 8), pi / 4 less atan((l - s) / (l + s)).
  const Mask far = large * Float(Real(0.41421356237309503)) < small;
  const Float over = select(far, large - small, small), under = select(far, large + small, large);
  const Float a = small_arc_tangent(over * inverse_or_zero(under));
  Float angle = select(far, Float(Real(0.78539816339744831)) - a, a);
  angle = select(ax < ay, Float(Real(1.5707963267948966)) - angle, angle);
  angle = select(x < zero, Float(Real(3.1415926535897931)) - angle, angle);
  return copysign(angle, y);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
