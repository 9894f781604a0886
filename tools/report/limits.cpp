// What one thread of the machine can do at most.
#include <algorithm>
#include <chrono>
#include <cstring>
#include <vector>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

#include "tools/report/throughput.hpp"

namespace manyworlds::report {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

constexpr int kRounds = 1 << 20;
constexpr int kChains = 10;  // enough to hide the latency of an addition

#if defined(__x86_64__)
// Ten independent chains of fused multiply-adds; the sum is returned so that nothing is left out.
__attribute__((target("avx512f"), noinline)) float chains512(float a) {
  __m512 x[kChains];
  for (int i = 0; i < kChains; ++i) x[i] = _mm512_set1_ps(a + static_cast<float>(i));
  const __m512 m = _mm512_set1_ps(0.999F), c = _mm512_set1_ps(a);
  for (int r = 0; r < kRounds; ++r) {
#pragma GCC unroll 10
    for (int i = 0; i < kChains; ++i) x[i] = _mm512_fmadd_ps(x[i], m, c);
  }
  for (int i = 1; i < kChains; ++i) x[0] = _mm512_add_ps(x[0], x[i]);
  return _mm512_cvtss_f32(x[0]);
}
__attribute__((target("avx2,fma"), noinline)) float chains256(float a) {
  __m256 x[kChains];
  for (int i = 0; i < kChains; ++i) x[i] = _mm256_set1_ps(a + static_cast<float>(i));
  const __m256 m = _mm256_set1_ps(0.999F), c = _mm256_set1_ps(a);
  for (int r = 0; r < kRounds; ++r) {
#pragma GCC unroll 10
    for (int i = 0; i < kChains; ++i) x[i] = _mm256_fmadd_ps(x[i], m, c);
  }
  for (int i = 1; i < kChains; ++i) x[0] = _mm256_add_ps(x[0], x[i]);
  return _mm256_cvtss_f32(x[0]);
}
#endif

double measure_gflops() {
  double best = 0;
#if defined(__x86_64__)
  const Isa isa = available_isas().back();
  if (isa == Isa::scalar) return 0;
  const double lanes = isa == Isa::avx512 ? 16 : 8;
  volatile float sink = 0.5F;
  for (int run = 0; run < 5; ++run) {
    const auto start = Clock::now();
    sink = isa == Isa::avx512 ? chains512(sink) : chains256(sink);
    best = std::max(best, 2 * lanes * kChains * kRounds / seconds_since(start) * 1e-9);
    sink = 0.5F;
  }
#endif
  return best;
}

double measure_bandwidth() {
  constexpr std::size_t kBytes = std::size_t{192} << 20;  // beyond any cache
  std::vector<unsigned char> from(kBytes, 1), to(kBytes, 2);
  double best = 0;
  for (int run = 0; run < 4; ++run) {
    const auto start = Clock::now();
    std::memcpy(to.data(), from.data(), kBytes);
    best = std::max(best, 2e-9 * static_cast<double>(kBytes) / seconds_since(start));
    from[static_cast<std::size_t>(run)] = to[kBytes - 1];  // the copy is not for nothing
  }
  return best;
}

}  // namespace

Limits measure_limits() { return {measure_gflops(), measure_bandwidth()}; }

}  // namespace manyworlds::report
