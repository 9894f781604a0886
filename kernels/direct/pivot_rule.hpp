// How each lane corrects its active set: all that is wrong at once, which may go in circles. A lane
// in which fewer have not become wrong for a while corrects the last one alone, which comes to an
// end (block principal pivoting: Judice and Pires 1994; one at a time: Murty 1974).
#pragma once

#include <cstdint>

#include "kernels/lane/float.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class PivotRule {
 public:
  PivotRule() {
    for (int l = 0; l < kLanes; ++l) fewest_[l] = 0x7fffffff;
  }
  MW_INLINE void count(std::uint32_t wrong) {
    for (; wrong != 0; wrong &= wrong - 1) ++count_[__builtin_ctz(wrong)];
  }
  // Of the lanes in which some are wrong those that correct all; begins to count anew.
  MW_INLINE std::uint32_t choose(std::uint32_t some) {
    std::uint32_t all = 0;
    for (; some != 0; some &= some - 1) {
      const int lane = __builtin_ctz(some);
      if (count_[lane] < fewest_[lane]) fewest_[lane] = count_[lane], tries_[lane] = kTries + 1;
      if (tries_[lane] > 0) --tries_[lane], all |= 1u << lane;
      count_[lane] = 0;
    }
    return all;
  }

 private:
  static constexpr int kTries = 3;  // without progress
  int count_[kLanes] = {}, fewest_[kLanes], tries_[kLanes] = {};
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
