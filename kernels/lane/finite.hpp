// Which lanes hold finite numbers.
#pragma once

#include "kernels/lane/algebra.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kMaxFinite = sizeof(Real) == 4 ? Real(3.4028234e38) : Real(1.79769e308);

// By comparison, so that NaN is not; without squares, which overflow.
MW_INLINE Mask is_finite(Float a) { return abs(a) <= Float(kMaxFinite); }
MW_INLINE Mask is_finite(Vec2 a) { return is_finite(a.x) & is_finite(a.y); }
MW_INLINE Mask is_finite(Vec3 a) { return is_finite(a.x) & is_finite(a.y) & is_finite(a.z); }
MW_INLINE Mask is_finite(Rot2 q) { return is_finite(q.c) & is_finite(q.s); }
MW_INLINE Mask is_finite(Quat q) {
  return is_finite(q.w) & is_finite(q.x) & is_finite(q.y) & is_finite(q.z);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
