// Rows: array-of-structures pieces of four or eight numbers, one row per lane, loaded and
// transposed in registers. Compacted lists of contacts use them, since there each lane works on
// its own pair of bodies. No arithmetic happens here and no value leaves its lane.
#pragma once

#include "kernels/lane/float.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

#if defined(MW_ISA_SCALAR)

MW_INLINE void load_rows4(const Real* base, const std::int32_t* offset, Float& a, Float& b,
                          Float& c, Float& d) {
  const Real* p = base + offset[0];
  a = p[0], b = p[1], c = p[2], d = p[3];
}
MW_INLINE void store_rows4(Real* base, const std::int32_t* offset, Float a, Float b, Float c,
                           Float d) {
  Real* p = base + offset[0];
  p[0] = a.v, p[1] = b.v, p[2] = c.v, p[3] = d.v;
}

#elif defined(MW_ISA_AVX512)

namespace raw {
MW_INLINE __m512 load_quads(const float* base, const std::int32_t* o, int k) {
  __m512 r = _mm512_castps128_ps512(_mm_load_ps(base + o[k]));
  r = _mm512_insertf32x4(r, _mm_load_ps(base + o[k + 4]), 1);
  r = _mm512_insertf32x4(r, _mm_load_ps(base + o[k + 8]), 2);
  return _mm512_insertf32x4(r, _mm_load_ps(base + o[k + 12]), 3);
}
MW_INLINE void store_quads(float* base, const std::int32_t* o, int k, __m512 v) {
  _mm_store_ps(base + o[k], _mm512_castps512_ps128(v));
  _mm_store_ps(base + o[k + 4], _mm512_extractf32x4_ps(v, 1));
  _mm_store_ps(base + o[k + 8], _mm512_extractf32x4_ps(v, 2));
  _mm_store_ps(base + o[k + 12], _mm512_extractf32x4_ps(v, 3));
}
// The 4x4 transpose is its own inverse: both directions use it.
MW_INLINE void transpose4(__m512& a, __m512& b, __m512& c, __m512& d) {
  const __m512 ac_low = _mm512_unpacklo_ps(a, c), ac_high = _mm512_unpackhi_ps(a, c);
  const __m512 bd_low = _mm512_unpacklo_ps(b, d), bd_high = _mm512_unpackhi_ps(b, d);
  a = _mm512_unpacklo_ps(ac_low, bd_low), b = _mm512_unpackhi_ps(ac_low, bd_low);
  c = _mm512_unpacklo_ps(ac_high, bd_high), d = _mm512_unpackhi_ps(ac_high, bd_high);
}
}  // namespace raw

MW_INLINE void load_rows4(const Real* base, const std::int32_t* offset, Float& a, Float& b,
                          Float& c, Float& d) {
  __m512 w = raw::load_quads(base, offset, 0), x = raw::load_quads(base, offset, 1);
  __m512 y = raw::load_quads(base, offset, 2), z = raw::load_quads(base, offset, 3);
  raw::transpose4(w, x, y, z);
  a = Batch(w), b = Batch(x), c = Batch(y), d = Batch(z);
}
MW_INLINE void store_rows4(Real* base, const std::int32_t* offset, Float a, Float b, Float c,
                           Float d) {
  __m512 w = a.v.data, x = b.v.data, y = c.v.data, z = d.v.data;
  raw::transpose4(w, x, y, z);
  raw::store_quads(base, offset, 0, w), raw::store_quads(base, offset, 1, x);
  raw::store_quads(base, offset, 2, y), raw::store_quads(base, offset, 3, z);
}

#else  // AVX2

namespace raw {
MW_INLINE __m256 load_quads(const float* base, const std::int32_t* o, int k) {
  return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_load_ps(base + o[k])),
                              _mm_load_ps(base + o[k + 4]), 1);
}
MW_INLINE void store_quads(float* base, const std::int32_t* o, int k, __m256 v) {
  _mm_store_ps(base + o[k], _mm256_castps256_ps128(v));
  _mm_store_ps(base + o[k + 4], _mm256_extractf128_ps(v, 1));
}
MW_INLINE void transpose4(__m256& a, __m256& b, __m256& c, __m256& d) {
  const __m256 ac_low = _mm256_unpacklo_ps(a, c), ac_high = _mm256_unpackhi_ps(a, c);
  const __m256 bd_low = _mm256_unpacklo_ps(b, d), bd_high = _mm256_unpackhi_ps(b, d);
  a = _mm256_unpacklo_ps(ac_low, bd_low), b = _mm256_unpackhi_ps(ac_low, bd_low);
  c = _mm256_unpacklo_ps(ac_high, bd_high), d = _mm256_unpackhi_ps(ac_high, bd_high);
}
MW_INLINE __m256d load_quads(const double* base, const std::int32_t* o, int k) {
  return _mm256_load_pd(base + o[k]);
}
MW_INLINE void store_quads(double* base, const std::int32_t* o, int k, __m256d v) {
  _mm256_store_pd(base + o[k], v);
}
MW_INLINE void transpose4(__m256d& a, __m256d& b, __m256d& c, __m256d& d) {
  const __m256d ab_low = _mm256_unpacklo_pd(a, b), ab_high = _mm256_unpackhi_pd(a, b);
  const __m256d cd_low = _mm256_unpacklo_pd(c, d), cd_high = _mm256_unpackhi_pd(c, d);
  a = _mm256_permute2f128_pd(ab_low, cd_low, 0x20);
  b = _mm256_permute2f128_pd(ab_high, cd_high, 0x20);
  c = _mm256_permute2f128_pd(ab_low, cd_low, 0x31);
  d = _mm256_permute2f128_pd(ab_high, cd_high, 0x31);
}
}  // namespace raw

MW_INLINE void load_rows4(const Real* base, const std::int32_t* offset, Float& a, Float& b,
                          Float& c, Float& d) {
  auto w = raw::load_quads(base, offset, 0), x = raw::load_quads(base, offset, 1);
  auto y = raw::load_quads(base, offset, 2), z = raw::load_quads(base, offset, 3);
  raw::transpose4(w, x, y, z);
  a = Batch(w), b = Batch(x), c = Batch(y), d = Batch(z);
}
MW_INLINE void store_rows4(Real* base, const std::int32_t* offset, Float a, Float b, Float c,
                           Float d) {
  auto w = a.v.data, x = b.v.data, y = c.v.data, z = d.v.data;
  raw::transpose4(w, x, y, z);
  raw::store_quads(base, offset, 0, w), raw::store_quads(base, offset, 1, x);
  raw::store_quads(base, offset, 2, y), raw::store_quads(base, offset, 3, z);
}

#endif

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
