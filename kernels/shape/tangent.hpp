// Vectors across a unit vector.
#pragma once

#include "kernels/lane/space.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Any unit vector perpendicular to n, continuous but for n.z = -1 (Duff et al. 2017).
MW_INLINE Vec3 any_tangent(Vec3 n) {
  const Float one(Real(1));
  const Float sign = copysign(one, n.z);
  const Float a = -(one / (sign + n.z));
  const Float b = n.x * n.y * a;
  return {fma(sign * n.x * n.x, a, one), sign * b, -(sign * n.x)};
}

// A unit vector across a unit vector.
MW_INLINE Vec3 across(Vec3 a) { return any_tangent(a); }
MW_INLINE Vec2 across(Vec2 a) { return {-a.y, a.x}; }

// A unit tangent to n that follows `axis` where it can, so that it is fixed to the body.
MW_INLINE Vec3 tangent_along(Vec3 axis, Vec3 n) {
  const Vec3 t = fnma(n, dot(n, axis), axis);
  const Float l2 = dot(t, t);
  const Mask usable = Float(Real(0.01)) < l2;
  return select(usable, t * (Float(Real(1)) / sqrt(select(usable, l2, Float(Real(1))))),
                any_tangent(n));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
