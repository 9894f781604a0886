// A 64-bit hash of a sequence of words, order-sensitive; for comparing states, not for security.
#pragma once

#include <bit>
#include <cstdint>

#include "src/base/random.hpp"

namespace manyworlds {

class Hasher {
 public:
  constexpr void add(std::uint64_t word) {
    state_ = mix_bits(state_ ^ word) + 0x9e3779b97f4a7c15ull;
  }
  constexpr void add(float x) { add(std::uint64_t{std::bit_cast<std::uint32_t>(x)}); }
  constexpr void add(double x) { add(std::bit_cast<std::uint64_t>(x)); }
  constexpr std::uint64_t value() const { return mix_bits(state_); }

 private:
  std::uint64_t state_ = 0x6d616e79776f726cull;
};

}  // namespace manyworlds
