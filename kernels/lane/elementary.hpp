// Sine, cosine and exponential of any argument, with the same bits in all instruction sets: every
// operation is correctly rounded.
//
// Sine and cosine: the argument less the nearest multiple of pi / 2, which is taken off in three
// pieces (Cody and Waite 1980), then the least-maximum polynomials of fdlibm (Sun 1993) on
// [-pi / 4, pi / 4]. Exponential: 2^k e^r with |r| <= ln 2 / 2 and Taylor's series of e^r.
#pragma once

#include "kernels/lane/float.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// To the nearest whole number, of |x| < 2^22 (float) or 2^51 (double); halves to the even one.
MW_INLINE Float round_to_whole(Float x) {
  constexpr Real kShift = sizeof(Real) == 4 ? Real(12582912) : Real(6755399441055744);
  return (x + Float(kShift)) - Float(kShift);
}

// To the next whole number below; numbers beyond those of round_to_whole are whole by themselves.
MW_INLINE Float round_down(Float x) {
  constexpr Real kWhole = sizeof(Real) == 4 ? Real(4194304) : Real(2251799813685248);
  const Float nearest = round_to_whole(x);
  const Float below = select(x < nearest, nearest - Float(Real(1)), nearest);
  return select(abs(x) < Float(kWhole), below, x);
}

struct SineAndCosine {
  Float sine, cosine;
};
MW_INLINE SineAndCosine sine_and_cosine(Float x) {
  // Pieces of pi / 2 with trailing zeros, so that their multiples up to 2^16 are exact.
  constexpr bool kFloat = sizeof(Real) == 4;
  constexpr Real kFirst = kFloat ? Real(1.5703125) : Real(1.57079632673412561417),
                 kSecond =
                     kFloat ? Real(4.837512969970703125e-4) : Real(6.07710050630396597660e-11),
                 kThird = kFloat ? Real(7.54978995489188216e-8) : Real(2.02226624879595063154e-21);
  const Float k = round_to_whole(x * Float(Real(0.63661977236758134)));
  Float r = fnma(k, Float(kFirst), x);
  r = fnma(k, Float(kSecond), r);
  r = fnma(k, Float(kThird), r);
  const Float z = r * r;
  constexpr Real kSine[] = {Real(-1.66666666666666324348e-01), Real(8.33333333332248946124e-03),
                            Real(-1.98412698298579493134e-04), Real(2.75573137070700676789e-06),
                            Real(-2.50507602534068634195e-08), Real(1.58969099521155010221e-10)};
  constexpr Real kCosine[] = {Real(4.16666666666666019037e-02), Real(-1.38888888888741095749e-03),
                              Real(2.48015872894767294178e-05), Real(-2.75573143513906633035e-07),
                              Real(2.08757232129817482790e-09), Real(-1.13596475577881948265e-11)};
  Float p(kSine[5]), q(kCosine[5]);
  for (int i = 4; i >= 0; --i) {
    p = fma(p, z, kSine[i]);
    q = fma(q, z, kCosine[i]);
  }
  const Float sine = fma(r * z, p, r), cosine = fma(z * z, q, fnma(Float(Real(0.5)), z, Real(1)));
  // The quadrant: k modulo 4, as -2 to 2; odd ones exchange the two.
  const Float quarter = fnma(Float(Real(4)), round_to_whole(k * Float(Real(0.25))), k);
  const Float size = abs(quarter), half(Real(0.5)), one_and_half(Real(1.5));
  const Mask odd = (half < size) & (size < one_and_half), opposite = one_and_half < size;
  const Mask forward = Float(Real(0)) < quarter;
  const Float quarter_sine = select(forward, cosine, -cosine);
  const Float quarter_cosine = select(forward, -sine, sine);
  return {select(odd, quarter_sine, select(opposite, -sine, sine)),
          select(odd, quarter_cosine, select(opposite, -cosine, cosine))};
}

// 2^k of a whole k, lane by lane: exact.
MW_INLINE Float power_of_two(Float k) {
  alignas(64) Real power[kLanes];
  k.store(power);
  for (Real& p : power) {
    const int exponent = static_cast<int>(p);
    // The builtins, since inline functions of <cmath> would be compiled for this instruction set.
    if constexpr (sizeof(Real) == 4) {
      p = __builtin_ldexpf(1, exponent);
    } else {
      p = static_cast<Real>(__builtin_ldexp(1, exponent));
    }
  }
  return Float::load(power);
}

// Infinite beyond the largest number, 0 below the smallest.
MW_INLINE Float exponential(Float x) {
  constexpr bool kFloat = sizeof(Real) == 4;
  constexpr Real kMax = kFloat ? Real(88.8) : Real(709.8), kMin = kFloat ? Real(-104) : Real(-746);
  constexpr Real kFirst = kFloat ? Real(0.693359375) : Real(6.93147180369123816490e-01),
                 kSecond = kFloat ? Real(-2.12194440e-4) : Real(1.90821492927058770002e-10);
  const Mask sane = x == x;
  const Float within = clamp(x, Float(kMin), Float(kMax));
  const Float k = round_to_whole(within * Float(Real(1.4426950408889634)));
  const Float r = fnma(k, Float(kSecond), fnma(k, Float(kFirst), within));
  constexpr int kTerms = kFloat ? 7 : 13;
  Float sum(Real(1));
  for (int i = kTerms; i > 0; --i) sum = fma(sum * r, Float(Real(1) / Real(i)), Real(1));
  // In two factors, since 2^k alone may be more than the result can be.
  const Float whole = round_to_whole(k * Float(Real(0.5)));
  return select(sane, sum * power_of_two(whole) * power_of_two(k - whole), x);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
