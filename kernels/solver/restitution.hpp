// Restitution: after the substeps the impacts of the step are played.
//
// The substeps resolve an impact without bounce and spread it over everything that touches. So the
// contacts that took part in one (participants.hpp) first give their impulses back, and then
// play their impacts, v' = -e v, until nothing approaches any more or restitution_sweeps is reached
// (impacts.hpp). A Newton's cradle then sends out as many balls as came in. The first impact of a
// contact uses the speed at the moment of touch, v^2 = v0^2 + 2 a s0, so that a bouncing ball
// reaches e^2 of its height at any time step. Resting contacts (slower than the threshold) keep
// what the substeps found. Friction follows (impact_friction.hpp), and a balance of energy
// (energy.hpp).
#pragma once

#include "kernels/solver/impact_friction.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Nothing of an impact is carried into the next step's warm start.
template <class S, int N>
MW_INLINE void finish_impact(const Constants& t, ContactBlock<S, N>& s,
                             const Bounce<S, N>& bounce) {
  if (bounce.participants == 0) return;
  const Mask part = mask_from_bits(bounce.participants);
  const auto drop = [&](Real* x) { select(part, Float(Real(0)), Float::load(x)).store(x); };
  for (int i = 0; i < N; ++i) drop(s.impulse[i]);
  if (t.has_friction) {
    for (int c = 0; c < S::kTangents; ++c) drop(s.tangent_impulse[c]);
    if constexpr (ContactBlock<S, N>::kTwist) drop(s.twist_impulse);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
