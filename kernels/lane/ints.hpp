// Ints: one whole number per lane, for what is looked up by index. Truth values are bits, one per
// lane, as the masks of lanes are everywhere else.
#pragma once

#include "kernels/lane/float.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

#if defined(MW_ISA_SCALAR)

namespace raw {
using IntRegister = std::int32_t;
MW_INLINE std::int32_t fill(std::int32_t x) { return x; }
MW_INLINE std::int32_t count_up() { return 0; }
MW_INLINE std::int32_t load(const std::int32_t* p) { return *p; }
MW_INLINE void store(std::int32_t* p, std::int32_t a) { *p = a; }
MW_INLINE std::int32_t add(std::int32_t a, std::int32_t b) { return a + b; }
MW_INLINE std::int32_t multiply(std::int32_t a, std::int32_t b) { return a * b; }
MW_INLINE std::int32_t bit_and(std::int32_t a, std::int32_t b) { return a & b; }
MW_INLINE std::int32_t upper_half(std::int32_t a) { return (a >> 16) & 0xffff; }
MW_INLINE unsigned less(std::int32_t a, std::int32_t b) { return a < b ? 1u : 0u; }
MW_INLINE unsigned equal(std::int32_t a, std::int32_t b) { return a == b ? 1u : 0u; }
MW_INLINE std::int32_t select(unsigned m, std::int32_t a, std::int32_t b) { return m & 1u ? a : b; }
MW_INLINE std::int32_t gather(const std::int32_t* p, std::int32_t at) { return p[at]; }
MW_INLINE Real gather(const Real* p, std::int32_t at) { return p[at]; }
}  // namespace raw

#elif defined(MW_ISA_AVX512)

namespace raw {
using IntRegister = __m512i;
MW_INLINE __m512i fill(std::int32_t x) { return _mm512_set1_epi32(x); }
MW_INLINE __m512i count_up() {
  return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
}
MW_INLINE __m512i load(const std::int32_t* p) { return _mm512_loadu_si512(p); }
MW_INLINE void store(std::int32_t* p, __m512i a) { _mm512_storeu_si512(p, a); }
MW_INLINE __m512i add(__m512i a, __m512i b) { return _mm512_add_epi32(a, b); }
MW_INLINE __m512i multiply(__m512i a, __m512i b) { return _mm512_mullo_epi32(a, b); }
MW_INLINE __m512i bit_and(__m512i a, __m512i b) { return _mm512_and_si512(a, b); }
MW_INLINE __m512i upper_half(__m512i a) { return _mm512_srli_epi32(a, 16); }
MW_INLINE unsigned less(__m512i a, __m512i b) { return _mm512_cmplt_epi32_mask(a, b); }
MW_INLINE unsigned equal(__m512i a, __m512i b) { return _mm512_cmpeq_epi32_mask(a, b); }
MW_INLINE __m512i select(unsigned m, __m512i a, __m512i b) {
  return _mm512_mask_blend_epi32(static_cast<__mmask16>(m), b, a);
}
MW_INLINE __m512i gather(const std::int32_t* p, __m512i at) {
  return _mm512_i32gather_epi32(at, p, 4);
}
MW_INLINE __m512 gather(const float* p, __m512i at) { return _mm512_i32gather_ps(at, p, 4); }
}  // namespace raw

#else  // AVX2, eight lanes of float or four of double

namespace raw {
#define MW_INT_OPERATIONS(REGISTER, PREFIX, SIZE, CAST)                                      \
  MW_INLINE void store(std::int32_t* p, REGISTER a) {                                        \
    PREFIX##_storeu_si##SIZE(reinterpret_cast<REGISTER*>(p), a);                             \
  }                                                                                          \
  MW_INLINE REGISTER add(REGISTER a, REGISTER b) { return PREFIX##_add_epi32(a, b); }        \
  MW_INLINE REGISTER multiply(REGISTER a, REGISTER b) { return PREFIX##_mullo_epi32(a, b); } \
  MW_INLINE REGISTER bit_and(REGISTER a, REGISTER b) { return PREFIX##_and_si##SIZE(a, b); } \
  MW_INLINE REGISTER upper_half(REGISTER a) { return PREFIX##_srli_epi32(a, 16); }           \
  MW_INLINE unsigned less(REGISTER a, REGISTER b) {                                          \
    return static_cast<unsigned>(PREFIX##_movemask_ps(CAST(PREFIX##_cmpgt_epi32(b, a))));    \
  }                                                                                          \
  MW_INLINE unsigned equal(REGISTER a, REGISTER b) {                                         \
    return static_cast<unsigned>(PREFIX##_movemask_ps(CAST(PREFIX##_cmpeq_epi32(a, b))));    \
  }                                                                                          \
  MW_INLINE REGISTER gather(const std::int32_t* p, REGISTER at) {                            \
    return PREFIX##_i32gather_epi32(p, at, 4);                                               \
  }
MW_INT_OPERATIONS(__m256i, _mm256, 256, _mm256_castsi256_ps)
MW_INT_OPERATIONS(__m128i, _mm, 128, _mm_castsi128_ps)
#undef MW_INT_OPERATIONS
MW_INLINE __m256i select(unsigned m, __m256i a, __m256i b) {
  const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(m)), lane);
  return _mm256_blendv_epi8(b, a, _mm256_cmpeq_epi32(set, lane));
}
MW_INLINE __m128i select(unsigned m, __m128i a, __m128i b) {
  const __m128i lane = _mm_setr_epi32(1, 2, 4, 8);
  const __m128i set = _mm_and_si128(_mm_set1_epi32(static_cast<int>(m)), lane);
  return _mm_blendv_epi8(b, a, _mm_cmpeq_epi32(set, lane));
}
MW_INLINE __m256 gather(const float* p, __m256i at) { return _mm256_i32gather_ps(p, at, 4); }
// GCC 12 warns of the undefined operand of its own unmasked intrinsic.
MW_INLINE __m256d gather(const double* p, __m128i at) {
  const __m256d zero = _mm256_setzero_pd();
  return _mm256_mask_i32gather_pd(zero, p, at, _mm256_cmp_pd(zero, zero, _CMP_EQ_OQ), 8);
}

#if MW_LANES == 8
using IntRegister = __m256i;
MW_INLINE __m256i fill(std::int32_t x) { return _mm256_set1_epi32(x); }
MW_INLINE __m256i count_up() { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }
MW_INLINE __m256i load(const std::int32_t* p) {
  return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(p));
}
#else
using IntRegister = __m128i;
MW_INLINE __m128i fill(std::int32_t x) { return _mm_set1_epi32(x); }
MW_INLINE __m128i count_up() { return _mm_setr_epi32(0, 1, 2, 3); }
MW_INLINE __m128i load(const std::int32_t* p) {
  return _mm_loadu_si128(reinterpret_cast<const __m128i*>(p));
}
#endif
}  // namespace raw

#endif

struct Ints {
  raw::IntRegister v;
  Ints() = default;
  MW_INLINE Ints(std::int32_t x) : v(raw::fill(x)) {}
#if !defined(MW_ISA_SCALAR)
  MW_INLINE Ints(raw::IntRegister x) : v(x) {}
#endif
  static MW_INLINE Ints load(const std::int32_t* p) { return raw::load(p); }
  static MW_INLINE Ints lanes() { return raw::count_up(); }  // 0, 1, 2, ...
  MW_INLINE void store(std::int32_t* p) const { raw::store(p, v); }
};
MW_INLINE Ints operator+(Ints a, Ints b) { return raw::add(a.v, b.v); }
MW_INLINE Ints operator*(Ints a, Ints b) { return raw::multiply(a.v, b.v); }
MW_INLINE unsigned operator<(Ints a, Ints b) { return raw::less(a.v, b.v); }
MW_INLINE unsigned operator==(Ints a, Ints b) { return raw::equal(a.v, b.v); }
MW_INLINE Ints select(unsigned lanes, Ints a, Ints b) { return raw::select(lanes, a.v, b.v); }

// Two indices below 2^16 in a number: low | high << 16.
MW_INLINE Ints low_half(Ints a) { return raw::bit_and(a.v, raw::fill(0xffff)); }
MW_INLINE Ints high_half(Ints a) { return raw::upper_half(a.v); }

// from[at] of each lane. All of `at` must be valid, also where the result is not used.
MW_INLINE Ints gather(const std::int32_t* from, Ints at) { return raw::gather(from, at.v); }
MW_INLINE Float gather(const Real* from, Ints at) {
#if defined(MW_ISA_SCALAR)
  return raw::gather(from, at.v);
#else
  return Batch(raw::gather(from, at.v));
#endif
}

// to[at] = values in the lanes of the mask.
MW_INLINE void scatter(Ints values, std::uint32_t mask, std::int32_t* to, Ints at) {
#if defined(MW_ISA_AVX512)
  _mm512_mask_i32scatter_epi32(to, static_cast<__mmask16>(mask), at.v, values.v, 4);
#else
  alignas(64) std::int32_t value[kLanes], place[kLanes];
  values.store(value), at.store(place);
  for (; mask != 0; mask &= mask - 1) {
    const int l = __builtin_ctz(mask);
    to[place[l]] = value[l];
  }
#endif
}

#if defined(MW_ISA_AVX512)
// The first n numbers; zero for the others, which are not read.
MW_INLINE Ints load_first(const std::int32_t* p, int n) {
  const std::uint32_t there = n < kLanes ? (1u << n) - 1 : kAllLanes;
  return _mm512_maskz_loadu_epi32(static_cast<__mmask16>(there), p);
}
// Which of them have some of these bits set.
MW_INLINE std::uint32_t with_any_of(Ints a, std::int32_t bits) {
  return _mm512_test_epi32_mask(a.v, raw::fill(bits));
}
// `which` of the values, one after the other, and zeros up to the length of a register.
MW_INLINE void store_packed(Ints values, std::uint32_t which, std::int32_t* to) {
  raw::store(to, _mm512_maskz_compress_epi32(static_cast<__mmask16>(which), values.v));
}
MW_INLINE Ints as_ints(Float a) { return _mm512_castps_si512(a.v.data); }  // its bits
#endif

// A number of items of which each lane has its own, [item][..., number, ...][lane]: of item 0 it is
// `of_first`.
template <class Item>
MW_INLINE Float gather_numbers(const LaneNumber& of_first, Ints item) {
  static_assert(sizeof(Item) % sizeof(Real) == 0);
  constexpr auto kStride = static_cast<std::int32_t>(sizeof(Item) / sizeof(Real));
  return gather(of_first.lane, item * Ints(kStride) + Ints::lanes());
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
