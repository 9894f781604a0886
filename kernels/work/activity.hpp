// Which lanes of a body take part in the step. Groups in which all bodies do never look at masks.
#pragma once

#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Lanes whose world is frozen: nothing about it changes any more.
MW_INLINE std::uint32_t frozen_lanes(const Group& g) {
  std::uint32_t any = 0, lanes = 0;
  for (int l = 0; l < kLanes; ++l) any |= g.status[l];
  if ((any & kernels::kFrozen) == 0) return 0;
  for (int l = 0; l < kLanes; ++l) {
    lanes |= static_cast<std::uint32_t>((g.status[l] & kernels::kFrozen) != 0) << l;
  }
  return lanes;
}

MW_INLINE bool has_idle_bodies(const Group& g) { return g.asleep && *g.idle != 0; }

// Lanes in which the body keeps its state.
MW_INLINE std::uint32_t idle_lanes(const Group& g, int body) {
  return g.asleep[body] | g.absent[body];
}

// Lanes in which two bodies can act on each other: both are there and one at least is awake.
MW_INLINE std::uint32_t live_lanes(const Group& g, int a, int b) {
  return ~(g.absent[a] | g.absent[b] | (g.asleep[a] & g.asleep[b]));
}

// Lanes in which the body is disabled, in any group.
MW_INLINE Mask absent_lanes(const Group& g, int body) {
  return mask_from_bits(has_idle_bodies(g) ? g.absent[body] & kAllLanes : 0);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
