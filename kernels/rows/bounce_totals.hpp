// What contacts do over all substeps, for restitution.
#pragma once

#include "kernels/rows/contact_block.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// After each relax pass: what the substep's contact has done so far.
template <class S, int N>
MW_INLINE void accumulate_bounce(const ContactBlock<S, N>& s, Bounce<S, N>& bounce, bool friction) {
  for (int i = 0; i < N; ++i) {
    (Float::load(bounce.total[i]) + Float::load(s.impulse[i])).store(bounce.total[i]);
  }
  if (friction) {
    for (int c = 0; c < S::kTangents; ++c) {
      (Float::load(bounce.total_tangent[c]) + Float::load(s.tangent_impulse[c]))
          .store(bounce.total_tangent[c]);
    }
    if constexpr (ContactBlock<S, N>::kTwist) {
      (Float::load(bounce.total_twist) + Float::load(s.twist_impulse)).store(bounce.total_twist);
    }
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
