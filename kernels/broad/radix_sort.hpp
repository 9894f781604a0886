// A stable sort of 64-bit words by their upper halves: a byte at a time. The time does not
// depend on the order before, so none has to be kept from step to step.
#pragma once

#include "kernels/lane/float.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

MW_INLINE std::uint64_t word_of(std::uint32_t high, std::uint32_t low) {
  return (static_cast<std::uint64_t>(high) << 32) | low;
}
MW_INLINE std::uint32_t high_of(std::uint64_t word) {
  return static_cast<std::uint32_t>(word >> 32);
}
MW_INLINE std::uint32_t low_of(std::uint64_t word) { return static_cast<std::uint32_t>(word); }

// The order of floats as that of unsigned numbers; NaN come first or last.
MW_INLINE std::uint32_t ordered_bits(float x) {
  const auto bits = __builtin_bit_cast(std::uint32_t, x);
  return (bits >> 31) != 0 ? ~bits : bits | 0x80000000u;
}

// Returns whichever of the two arrays holds the result.
inline std::uint64_t* radix_sort(std::uint64_t* words, std::uint64_t* spare, std::int32_t count) {
  constexpr int kPasses = 4, kBits = 8, kBuckets = 1 << kBits;
  std::int32_t start[kPasses][kBuckets] = {};
  const auto digit = [](std::uint64_t word, int pass) {
    return static_cast<std::int32_t>(high_of(word) >> (pass * kBits) & (kBuckets - 1));
  };
  for (std::int32_t i = 0; i < count; ++i) {
    for (int p = 0; p < kPasses; ++p) ++start[p][digit(words[i], p)];
  }
  for (int p = 0; p < kPasses; ++p) {
    if (count > 0 && start[p][digit(words[0], p)] == count) continue;  // all alike
    std::int32_t sum = 0;
    for (std::int32_t& s : start[p]) {
      const std::int32_t size = s;
      s = sum;
      sum += size;
    }
    for (std::int32_t i = 0; i < count; ++i) spare[start[p][digit(words[i], p)]++] = words[i];
    std::uint64_t* sorted = spare;
    spare = words;
    words = sorted;
  }
  return words;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
