// The largest of numbers in several lanes, for the one place where lanes hold parts of one world's
// table and not worlds: the corners of a hull (shape/farthest_corner.hpp). It only compares, so the
// answer is the same however many lanes there are.
#pragma once

#include "kernels/lane/float.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace raw {
#if defined(MW_ISA_AVX512)
MW_INLINE float largest(__m512 a) { return _mm512_reduce_max_ps(a); }
#elif !defined(MW_ISA_SCALAR)
MW_INLINE float largest(__m256 a) {
  __m128 x = _mm_max_ps(_mm256_castps256_ps128(a), _mm256_extractf128_ps(a, 1));
  x = _mm_max_ps(x, _mm_movehl_ps(x, x));
  return _mm_cvtss_f32(_mm_max_ss(x, _mm_movehdup_ps(x)));
}
MW_INLINE double largest(__m256d a) {
  const __m128d x = _mm_max_pd(_mm256_castpd256_pd128(a), _mm256_extractf128_pd(a, 1));
  return _mm_cvtsd_f64(_mm_max_sd(x, _mm_unpackhi_pd(x, x)));
}
#endif
}  // namespace raw

// The least of the indices at which a value is the largest of all. No value is NaN.
MW_INLINE Real index_of_largest(Float value, Float index) {
#if defined(MW_ISA_SCALAR)
  static_cast<void>(value);
  return index.v;
#else
  alignas(64) Real at[kLanes];
  index.store(at);
  unsigned largest = bits(value == Float(raw::largest(value.v.data)));
  Real least = at[__builtin_ctz(largest)];
  for (largest &= largest - 1; largest != 0; largest &= largest - 1) {
    const Real next = at[__builtin_ctz(largest)];
    least = next < least ? next : least;
  }
  return least;
#endif
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
