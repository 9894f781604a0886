// Rows: array-of-structures pieces of four or eight numbers, one row per lane, loaded and
// transposed in registers. Compacted lists of contacts use them, since there each lane works on
// its own pair of bodies. No arithmetic happens here and no value leaves its lane. Rows begin at
// multiples of 16 bytes. Eight floats at once are half the loads, stores and inserts of twice four.
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
MW_INLINE void load_rows8(const Real* base, const std::int32_t* offset, Float& a, Float& b,
                          Float& c, Float& d, Float& e, Float& f, Float& g, Float& h) {
  load_rows4(base, offset, a, b, c, d);
  load_rows4(base + 4, offset, e, f, g, h);
}
MW_INLINE void store_rows8(Real* base, const std::int32_t* offset, Float a, Float b, Float c,
                           Float d, Float e, Float f, Float g, Float h) {
  store_rows4(base, offset, a, b, c, d);
  store_rows4(base + 4, offset, e, f, g, h);
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

namespace raw {
// Rows of two lanes, side by side.
MW_INLINE __m512 load_octets(const float* base, std::int32_t low, std::int32_t high) {
  return _mm512_insertf32x8(_mm512_castps256_ps512(_mm256_loadu_ps(base + low)),
                            _mm256_loadu_ps(base + high), 1);
}
MW_INLINE void store_octets(float* base, std::int32_t low, std::int32_t high, __m512 v) {
  _mm256_storeu_ps(base + low, _mm512_castps512_ps256(v));
  _mm256_storeu_ps(base + high, _mm512_extractf32x8_ps(v, 1));
}
// The first and the last four numbers of the rows of lanes k, k + 4, k + 8, k + 12.
MW_INLINE void load_halves(const float* base, const std::int32_t* o, int k, __m512& first,
                           __m512& last) {
  const __m512 low = load_octets(base, o[k], o[k + 4]);
  const __m512 high = load_octets(base, o[k + 8], o[k + 12]);
  first = _mm512_shuffle_f32x4(low, high, 0x88), last = _mm512_shuffle_f32x4(low, high, 0xdd);
}
MW_INLINE void store_halves(float* base, const std::int32_t* o, int k, __m512 first, __m512 last) {
  const __m512i low = _mm512_setr_epi32(0, 1, 2, 3, 16, 17, 18, 19, 4, 5, 6, 7, 20, 21, 22, 23);
  const __m512i high = _mm512_add_epi32(low, _mm512_set1_epi32(8));
  store_octets(base, o[k], o[k + 4], _mm512_permutex2var_ps(first, low, last));
  store_octets(base, o[k + 8], o[k + 12], _mm512_permutex2var_ps(first, high, last));
}
}  // namespace raw

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

namespace raw {
// The first and the last four numbers of the rows of lanes k and k + 4.
MW_INLINE void load_halves(const float* base, const std::int32_t* o, int k, __m256& first,
                           __m256& last) {
  const __m256 low = _mm256_loadu_ps(base + o[k]), high = _mm256_loadu_ps(base + o[k + 4]);
  first = _mm256_permute2f128_ps(low, high, 0x20), last = _mm256_permute2f128_ps(low, high, 0x31);
}
MW_INLINE void load_halves(const double* base, const std::int32_t* o, int k, __m256d& first,
                           __m256d& last) {
  first = load_quads(base, o, k), last = load_quads(base + 4, o, k);
}
MW_INLINE void store_halves(double* base, const std::int32_t* o, int k, __m256d first,
                            __m256d last) {
  store_quads(base, o, k, first), store_quads(base + 4, o, k, last);
}
MW_INLINE void store_halves(float* base, const std::int32_t* o, int k, __m256 first, __m256 last) {
  _mm256_storeu_ps(base + o[k], _mm256_permute2f128_ps(first, last, 0x20));
  _mm256_storeu_ps(base + o[k + 4], _mm256_permute2f128_ps(first, last, 0x31));
}
}  // namespace raw

#endif

#if !defined(MW_ISA_SCALAR)

MW_INLINE void load_rows8(const Real* base, const std::int32_t* offset, Float& a, Float& b,
                          Float& c, Float& d, Float& e, Float& f, Float& g, Float& h) {
  decltype(a.v.data) p[4], q[4];
  for (int k = 0; k < 4; ++k) raw::load_halves(base, offset, k, p[k], q[k]);
  raw::transpose4(p[0], p[1], p[2], p[3]);
  raw::transpose4(q[0], q[1], q[2], q[3]);
  a = Batch(p[0]), b = Batch(p[1]), c = Batch(p[2]), d = Batch(p[3]);
  e = Batch(q[0]), f = Batch(q[1]), g = Batch(q[2]), h = Batch(q[3]);
}
MW_INLINE void store_rows8(Real* base, const std::int32_t* offset, Float a, Float b, Float c,
                           Float d, Float e, Float f, Float g, Float h) {
  decltype(a.v.data) p[4] = {a.v.data, b.v.data, c.v.data, d.v.data};
  decltype(a.v.data) q[4] = {e.v.data, f.v.data, g.v.data, h.v.data};
  raw::transpose4(p[0], p[1], p[2], p[3]);
  raw::transpose4(q[0], q[1], q[2], q[3]);
  for (int k = 0; k < 4; ++k) raw::store_halves(base, offset, k, p[k], q[k]);
}

#endif

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
