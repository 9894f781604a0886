// Float and Mask: one number, or one truth value, per lane; a lane is a world.
//
// The only file that includes xsimd. xsimd 8.1 does not fuse on AVX-512 and plain AVX2, and cannot
// make bits of a mask, so those come from intrinsics here. Nothing below mixes lanes. Every
// operation is correctly rounded or pure bit logic, so all instruction sets give the same bits:
//   max(a, b) is (a > b ? a : b) and min(a, b) is (a < b ? a : b), also for NaN and signed zeros.
// The build sets MW_REAL, MW_LANES, MW_KERNEL_NAMESPACE and one of MW_ISA_SCALAR/AVX2/AVX512.
#pragma once

#include <cmath>
#include <cstdint>

#if !defined(MW_ISA_SCALAR)
#include <immintrin.h>

#include <xsimd/xsimd.hpp>
#endif

// In the scalar kernels, which run where nothing wider does, a function is a call where the
// compiler sees fit: inlined by force they would be the largest of all, by twice.
#if defined(MW_ISA_SCALAR)
#define MW_INLINE inline
#else
#define MW_INLINE inline __attribute__((always_inline))
#endif

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Real = MW_REAL;
inline constexpr int kLanes = MW_LANES;
inline constexpr unsigned kAllLanes = (1u << kLanes) - 1u;

#if defined(MW_ISA_SCALAR)

struct Mask {
  bool v;
};
struct Float {
  Real v;
  Float() = default;
  MW_INLINE Float(Real x) : v(x) {}
  static MW_INLINE Float load(const Real* p) { return *p; }
  static MW_INLINE Float load_unaligned(const Real* p) { return *p; }
  MW_INLINE void store(Real* p) const { *p = v; }
};
MW_INLINE Float operator+(Float a, Float b) { return a.v + b.v; }
MW_INLINE Float operator-(Float a, Float b) { return a.v - b.v; }
MW_INLINE Float operator*(Float a, Float b) { return a.v * b.v; }
MW_INLINE Float operator/(Float a, Float b) { return a.v / b.v; }
MW_INLINE Float operator-(Float a) { return -a.v; }
MW_INLINE Float fma(Float a, Float b, Float c) { return std::fma(a.v, b.v, c.v); }
// -a b + c and a b - c, each rounded once.
MW_INLINE Float fnma(Float a, Float b, Float c) { return std::fma(-a.v, b.v, c.v); }
MW_INLINE Float fms(Float a, Float b, Float c) { return std::fma(a.v, b.v, -c.v); }
MW_INLINE Float sqrt(Float a) { return std::sqrt(a.v); }
MW_INLINE Float min(Float a, Float b) { return a.v < b.v ? a.v : b.v; }
MW_INLINE Float max(Float a, Float b) { return a.v > b.v ? a.v : b.v; }
MW_INLINE Float abs(Float a) { return std::fabs(a.v); }
MW_INLINE Float copysign(Float a, Float s) { return std::copysign(a.v, s.v); }
MW_INLINE Mask operator<(Float a, Float b) { return {a.v < b.v}; }
MW_INLINE Mask operator<=(Float a, Float b) { return {a.v <= b.v}; }
MW_INLINE Mask operator==(Float a, Float b) { return {a.v == b.v}; }
MW_INLINE Mask operator&(Mask a, Mask b) { return {a.v && b.v}; }
MW_INLINE Mask operator|(Mask a, Mask b) { return {a.v || b.v}; }
MW_INLINE Mask operator!(Mask a) { return {!a.v}; }
MW_INLINE Float select(Mask m, Float a, Float b) { return m.v ? a : b; }
MW_INLINE unsigned bits(Mask m) { return m.v ? 1u : 0u; }
MW_INLINE Mask mask_from_bits(unsigned b) { return {(b & 1u) != 0}; }

#else

#if defined(MW_ISA_AVX512)
using Arch = xsimd::avx512bw;
#else
using Arch = xsimd::fma3<xsimd::avx2>;
#endif
using Batch = xsimd::batch<Real, Arch>;
using BatchBool = xsimd::batch_bool<Real, Arch>;
static_assert(Batch::size == kLanes);

struct Mask {
  BatchBool v;
};
struct Float {
  Batch v;
  Float() = default;
  MW_INLINE Float(Real x) : v(x) {}
  MW_INLINE Float(Batch x) : v(x) {}
  static MW_INLINE Float load(const Real* p) { return Batch::load_aligned(p); }
  static MW_INLINE Float load_unaligned(const Real* p) { return Batch::load_unaligned(p); }
  // The vector types of intrinsics may alias anything: after each of their stores compilers would
  // load again what they know of plans, counts and pointers. This one is memory of Reals.
  MW_INLINE void store(Real* p) const {
    using Register = typename Batch::register_type;
    using Reals = Real __attribute__((vector_size(sizeof(Register))));
    *reinterpret_cast<Reals*>(p) = reinterpret_cast<Reals>(v.data);
  }
};
MW_INLINE Float operator+(Float a, Float b) { return a.v + b.v; }
MW_INLINE Float operator-(Float a, Float b) { return a.v - b.v; }
MW_INLINE Float operator*(Float a, Float b) { return a.v * b.v; }
MW_INLINE Float operator/(Float a, Float b) { return a.v / b.v; }
MW_INLINE Float sqrt(Float a) { return xsimd::sqrt(a.v); }
MW_INLINE Float select(Mask m, Float a, Float b) { return xsimd::select(m.v, a.v, b.v); }
MW_INLINE Mask operator&(Mask a, Mask b) { return {a.v & b.v}; }
MW_INLINE Mask operator|(Mask a, Mask b) { return {a.v | b.v}; }

namespace raw {  // one overload per register type
#if defined(MW_ISA_AVX512)
MW_INLINE __m512 fma(__m512 a, __m512 b, __m512 c) { return _mm512_fmadd_ps(a, b, c); }
MW_INLINE __m512 fnma(__m512 a, __m512 b, __m512 c) { return _mm512_fnmadd_ps(a, b, c); }
MW_INLINE __m512 fms(__m512 a, __m512 b, __m512 c) { return _mm512_fmsub_ps(a, b, c); }
MW_INLINE __m512 min(__m512 a, __m512 b) { return _mm512_min_ps(a, b); }
MW_INLINE __m512 max(__m512 a, __m512 b) { return _mm512_max_ps(a, b); }
MW_INLINE __m512 bit_and(__m512 a, __m512 b) { return _mm512_and_ps(a, b); }
MW_INLINE __m512 bit_andnot(__m512 a, __m512 b) { return _mm512_andnot_ps(a, b); }
MW_INLINE __m512 bit_or(__m512 a, __m512 b) { return _mm512_or_ps(a, b); }
MW_INLINE __m512 bit_xor(__m512 a, __m512 b) { return _mm512_xor_ps(a, b); }
MW_INLINE __mmask16 less(__m512 a, __m512 b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
MW_INLINE __mmask16 less_equal(__m512 a, __m512 b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
MW_INLINE __mmask16 equal(__m512 a, __m512 b) { return _mm512_cmp_ps_mask(a, b, _CMP_EQ_OQ); }
MW_INLINE unsigned bits(__mmask16 m) { return m; }
MW_INLINE __mmask16 from_bits(unsigned b, __m512) { return static_cast<__mmask16>(b); }
MW_INLINE __mmask16 invert(__mmask16 m) { return static_cast<__mmask16>(~m); }
#else
MW_INLINE __m256 fma(__m256 a, __m256 b, __m256 c) { return _mm256_fmadd_ps(a, b, c); }
MW_INLINE __m256 fnma(__m256 a, __m256 b, __m256 c) { return _mm256_fnmadd_ps(a, b, c); }
MW_INLINE __m256 fms(__m256 a, __m256 b, __m256 c) { return _mm256_fmsub_ps(a, b, c); }
MW_INLINE __m256 min(__m256 a, __m256 b) { return _mm256_min_ps(a, b); }
MW_INLINE __m256 max(__m256 a, __m256 b) { return _mm256_max_ps(a, b); }
MW_INLINE __m256 bit_and(__m256 a, __m256 b) { return _mm256_and_ps(a, b); }
MW_INLINE __m256 bit_andnot(__m256 a, __m256 b) { return _mm256_andnot_ps(a, b); }
MW_INLINE __m256 bit_or(__m256 a, __m256 b) { return _mm256_or_ps(a, b); }
MW_INLINE __m256 bit_xor(__m256 a, __m256 b) { return _mm256_xor_ps(a, b); }
MW_INLINE __m256 less(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
MW_INLINE __m256 less_equal(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
MW_INLINE __m256 equal(__m256 a, __m256 b) { return _mm256_cmp_ps(a, b, _CMP_EQ_OQ); }
MW_INLINE unsigned bits(__m256 m) { return static_cast<unsigned>(_mm256_movemask_ps(m)); }
MW_INLINE __m256 from_bits(unsigned b, __m256) {
  const __m256i lane = _mm256_setr_epi32(1, 2, 4, 8, 16, 32, 64, 128);
  const __m256i set = _mm256_and_si256(_mm256_set1_epi32(static_cast<int>(b)), lane);
  return _mm256_castsi256_ps(_mm256_cmpeq_epi32(set, lane));
}
MW_INLINE __m256 invert(__m256 m) {
  return _mm256_xor_ps(m, _mm256_castsi256_ps(_mm256_set1_epi32(-1)));
}
MW_INLINE __m256d fma(__m256d a, __m256d b, __m256d c) { return _mm256_fmadd_pd(a, b, c); }
MW_INLINE __m256d fnma(__m256d a, __m256d b, __m256d c) { return _mm256_fnmadd_pd(a, b, c); }
MW_INLINE __m256d fms(__m256d a, __m256d b, __m256d c) { return _mm256_fmsub_pd(a, b, c); }
MW_INLINE __m256d min(__m256d a, __m256d b) { return _mm256_min_pd(a, b); }
MW_INLINE __m256d max(__m256d a, __m256d b) { return _mm256_max_pd(a, b); }
MW_INLINE __m256d bit_and(__m256d a, __m256d b) { return _mm256_and_pd(a, b); }
MW_INLINE __m256d bit_andnot(__m256d a, __m256d b) { return _mm256_andnot_pd(a, b); }
MW_INLINE __m256d bit_or(__m256d a, __m256d b) { return _mm256_or_pd(a, b); }
MW_INLINE __m256d bit_xor(__m256d a, __m256d b) { return _mm256_xor_pd(a, b); }
MW_INLINE __m256d less(__m256d a, __m256d b) { return _mm256_cmp_pd(a, b, _CMP_LT_OQ); }
MW_INLINE __m256d less_equal(__m256d a, __m256d b) { return _mm256_cmp_pd(a, b, _CMP_LE_OQ); }
MW_INLINE __m256d equal(__m256d a, __m256d b) { return _mm256_cmp_pd(a, b, _CMP_EQ_OQ); }
MW_INLINE unsigned bits(__m256d m) { return static_cast<unsigned>(_mm256_movemask_pd(m)); }
MW_INLINE __m256d from_bits(unsigned b, __m256d) {
  const __m256i lane = _mm256_setr_epi64x(1, 2, 4, 8);
  const __m256i set = _mm256_and_si256(_mm256_set1_epi64x(static_cast<long long>(b)), lane);
  return _mm256_castsi256_pd(_mm256_cmpeq_epi64(set, lane));
}
MW_INLINE __m256d invert(__m256d m) {
  return _mm256_xor_pd(m, _mm256_castsi256_pd(_mm256_set1_epi64x(-1)));
}
#endif
}  // namespace raw

MW_INLINE Float fma(Float a, Float b, Float c) {
  return Batch(raw::fma(a.v.data, b.v.data, c.v.data));
}
MW_INLINE Float fnma(Float a, Float b, Float c) {
  return Batch(raw::fnma(a.v.data, b.v.data, c.v.data));
}
MW_INLINE Float fms(Float a, Float b, Float c) {
  return Batch(raw::fms(a.v.data, b.v.data, c.v.data));
}
MW_INLINE Float min(Float a, Float b) { return Batch(raw::min(a.v.data, b.v.data)); }
MW_INLINE Float max(Float a, Float b) { return Batch(raw::max(a.v.data, b.v.data)); }
MW_INLINE Float operator-(Float a) { return Batch(raw::bit_xor(a.v.data, Batch(Real(-0.0)).data)); }
MW_INLINE Float abs(Float a) { return Batch(raw::bit_andnot(Batch(Real(-0.0)).data, a.v.data)); }
MW_INLINE Float copysign(Float a, Float s) {
  const auto sign = Batch(Real(-0.0)).data;
  return Batch(raw::bit_or(raw::bit_andnot(sign, a.v.data), raw::bit_and(sign, s.v.data)));
}
MW_INLINE Mask operator<(Float a, Float b) { return {BatchBool(raw::less(a.v.data, b.v.data))}; }
MW_INLINE Mask operator<=(Float a, Float b) {
  return {BatchBool(raw::less_equal(a.v.data, b.v.data))};
}
MW_INLINE Mask operator==(Float a, Float b) { return {BatchBool(raw::equal(a.v.data, b.v.data))}; }
MW_INLINE Mask operator!(Mask a) { return {BatchBool(raw::invert(a.v.data))}; }
MW_INLINE unsigned bits(Mask m) { return raw::bits(m.v.data); }
MW_INLINE Mask mask_from_bits(unsigned b) {
  return {BatchBool(raw::from_bits(b, Batch(Real(0)).data))};
}

#endif

// One number per lane in memory.
struct LaneNumber {
  Real lane[kLanes];
  MW_INLINE operator Float() const { return Float::load(lane); }
};

MW_INLINE Float lane_numbers() {
  alignas(64) static constexpr Real kNumbers[] = {0, 1, 2,  3,  4,  5,  6,  7,
                                                  8, 9, 10, 11, 12, 13, 14, 15};
  return Float::load(kNumbers);
}
// Of one number, as fma() of many. std::fma would be a function that the kernels share.
MW_INLINE Real fma(Real a, Real b, Real c) {
  if constexpr (sizeof(Real) == sizeof(float)) {
    return __builtin_fmaf(static_cast<float>(a), static_cast<float>(b), static_cast<float>(c));
  } else {
    return static_cast<Real>(__builtin_fma(a, b, c));
  }
}

MW_INLINE bool any(Mask m) { return bits(m) != 0; }
MW_INLINE bool all(Mask m) { return bits(m) == kAllLanes; }
MW_INLINE Float clamp(Float x, Float low, Float high) { return min(max(x, low), high); }
MW_INLINE Float square(Float a) { return a * a; }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
