// Logarithm and what is made of it or of exponentials: real powers and hyperbolic tangents; and
// remainders. The same bits in all instruction sets, as in elementary.hpp.
//
// Logarithm: x = 2^k m with m in [1 / sqrt 2, sqrt 2), and the polynomial of fdlibm (Sun 1993) in
// s = f / (2 + f), f = m - 1.
#pragma once

#include "kernels/lane/elementary.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// What is subtracted from the bits are those of 1 / sqrt 2: the exponent then is that of the
// nearest power of two.
MW_INLINE float split(float& x) {
  constexpr std::uint32_t kHalfRoot = 0x3f3504f3u;
  const std::uint32_t from = __builtin_bit_cast(std::uint32_t, x) - kHalfRoot;
  x = __builtin_bit_cast(float, (from & 0x007fffffu) + kHalfRoot);
  return static_cast<float>(static_cast<std::int32_t>(from) >> 23);
}
MW_INLINE double split(double& x) {
  constexpr std::uint64_t kHalfRoot = 0x3fe6a09e667f3bcdull;
  const std::uint64_t from = __builtin_bit_cast(std::uint64_t, x) - kHalfRoot;
  x = __builtin_bit_cast(double, (from & 0x000fffffffffffffull) + kHalfRoot);
  return static_cast<double>(static_cast<std::int64_t>(from) >> 52);
}

struct MantissaAndExponent {
  Float mantissa, exponent;
};
// x = m 2^k of positive finite numbers that are not denormal, m in [1 / sqrt 2, sqrt 2); of others
// anything. Lane by lane: exact.
MW_INLINE MantissaAndExponent split(Float x) {
  alignas(64) Real mantissa[kLanes], exponent[kLanes];
  x.store(mantissa);
  for (int l = 0; l < kLanes; ++l) exponent[l] = split(mantissa[l]);
  return {Float::load(mantissa), Float::load(exponent)};
}

// Minus infinity of 0, not a number of what is below. Denormals count as 0, as steps have them.
MW_INLINE Float logarithm(Float x) {
  constexpr bool kFloat = sizeof(Real) == 4;
  constexpr Real kFirst = kFloat ? Real(0.693359375) : Real(6.93147180369123816490e-01),
                 kSecond = kFloat ? Real(-2.12194440e-4) : Real(1.90821492927058770002e-10);
  constexpr Real kInfinity = kFloat ? __builtin_huge_valf() : Real(__builtin_huge_val());
  constexpr Real kSmallest = kFloat ? Real(1.17549435e-38) : Real(2.2250738585072014e-308);
  constexpr Real kTerms[] = {Real(6.666666666666735130e-01), Real(3.999999999940941908e-01),
                             Real(2.857142874366239149e-01), Real(2.222219843214978396e-01),
                             Real(1.818357216161805012e-01), Real(1.531383769920937332e-01),
                             Real(1.479819860511658591e-01)};
  const auto [m, k] = split(x);
  const Float f = m - Float(Real(1)), s = f / (f + Float(Real(2))), z = s * s;
  Float r(kTerms[6]);
  for (int i = 5; i >= 0; --i) r = fma(r, z, kTerms[i]);
  const Float half = Float(Real(0.5)) * f * f;
  // k ln 2 + f - (half - s (half + z r)), the smallest first.
  const Float small = fma(k, Float(kSecond), s * fma(z, r, half));
  const Float result = fma(k, Float(kFirst), f - (half - small));
  const Float zero(Real(0)), infinity(kInfinity);
  const Mask ordinary = (Float(kSmallest) <= x) & (x < infinity);
  const Mask nothing = (x < Float(kSmallest)) & (Float(-kSmallest) < x);
  return select(ordinary, result,
                select(nothing, -infinity, select(x == infinity, infinity, zero / zero)));
}

// |a|^b, with the sign of a where b is a whole number and odd; not a number where a < 0 and b is
// not whole. a^0 is 1. Good to 2 + |b ln a| units in the last place.
MW_INLINE Float power(Float a, Float b) {
  const Float zero(Real(0)), one(Real(1)), half(Real(0.5));
  const Float size = exponential(b * logarithm(abs(a)));
  const Mask whole = round_down(b) == b;
  const Mask odd = !(round_down(b * half) == b * half);
  const Float of_negative = select(whole, select(odd, -size, size), zero / zero);
  const Float of_any = select(a < zero, of_negative, size);
  return select((b == zero) | (a == one), one, of_any);
}

// (1 - e) / (1 + e) with e = exp(-2 |x|); where that would cancel, by the series of exp(2 x) - 1.
MW_INLINE Float hyperbolic_tangent(Float x) {
  constexpr int kTerms = sizeof(Real) == 4 ? 7 : 13;
  const Float one(Real(1)), two(Real(2)), size = abs(x);
  const Float e = exponential(-(size + size));
  const Float large = (one - e) / (one + e);
  // Of |x| up to 0.17: 2 x up to ln 2 / 2, as in exponential().
  const Float y = size + size;
  Float sum(Real(1));
  for (int i = kTerms; i > 1; --i) sum = fma(sum * y, Float(Real(1) / Real(i)), Real(1));
  const Float less = sum * y, small = less / (less + two);
  return copysign(select(size < Float(Real(0.17)), small, large), x);
}

// a less the multiple of b that leaves 0 up to b, b not included; of a negative b, down to b.
// Exact up to rounding where |a / b| < 2^22 (float) or 2^51 (double).
MW_INLINE Float modulo(Float a, Float b) {
  const Float zero(Real(0));
  Float rest = fnma(round_down(a / b), b, a);
  // The quotient is rounded, and may be so to the next whole number.
  const Mask beyond = ((rest < zero) & (zero < b)) | ((zero < rest) & (b < zero));
  rest = select(beyond, rest + b, rest);
  return select(abs(b) <= abs(rest), rest - b, rest);
}

// Minus 1, 0 or 1; not a number of what is none.
MW_INLINE Float sign(Float a) {
  const Float zero(Real(0)), one(Real(1));
  return select(zero < a, one, select(a < zero, -one, select(a == zero, zero, a)));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
