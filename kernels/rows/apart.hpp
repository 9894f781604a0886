// Neighbouring blocks that are about different bodies in every lane. Neither reads what the other
// writes, so they may be solved side by side, with the bits of one after the other.
#pragma once

#include "kernels/lane/ints.hpp"
#include "kernels/rows/side.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Of blocks of one list. What is fixed is no body, and idle lanes change nothing.
template <class A, bool kDense>
MW_INLINE bool are_apart(const RowBodies& s, const RowBodies& other) {
  std::uint32_t shared;
  if constexpr (kDense) {
    bool same = s.body_b == other.body_b;
    if constexpr (A::kMoves) {
      same |= s.body_a == other.body_a || s.body_a == other.body_b || s.body_b == other.body_a;
    }
    shared = same ? kAllLanes : 0;
  } else {
    const Ints b = Ints::load(s.offset_b), other_b = Ints::load(other.offset_b);
    shared = b == other_b;
    if constexpr (A::kMoves) {
      const Ints a = Ints::load(s.offset_a), other_a = Ints::load(other.offset_a);
      shared |= (a == other_a) | (a == other_b) | (b == other_a);
    }
  }
  return (shared & s.mask & other.mask) == 0;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
