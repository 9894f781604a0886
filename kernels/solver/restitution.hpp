// Restitution: after the substeps the impacts of the step are played.
//
// The substeps resolve an impact without bounce and spread it over everything that touches. So the
// contacts that took part in one (participants.hpp) first give their normal impulses back, and then
// play their impacts, v' = -e v, until nothing approaches any more or restitution_sweeps is reached
// (impacts.hpp). A Newton's cradle then sends out as many balls as came in. The first impact of a
// contact uses the speed at the moment of touch, v^2 = v0^2 + 2 a s0, so that a bouncing ball
// reaches e^2 of its height at any time step. Resting contacts (slower than the threshold) keep
// what the substeps found. Friction follows, and a balance of energy (energy.hpp).
#pragma once

#include "kernels/solver/impacts.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Friction of the impacts, bounded by mu times all normal impulse of the step; and nothing of an
// impact is carried into the next step's warm start.
template <bool kDense, bool kFriction, class S, int N, class A>
MW_INLINE void finish_impact(Work& w, SidedBlock<S, N, A>& s, Bounce<S, N>& bounce) {
  if (bounce.participants == 0) return;
  const Mask part = mask_from_bits(bounce.participants);
  const Float zero(Real(0));
  if constexpr (kFriction) {
    RowVelocities<S, A, kDense> v(w, s), before = v;
    Float total[N], after[2], twist_after(Real(0));
    for (int i = 0; i < N; ++i) total[i] = Float::load(bounce.total[i]);
    FrictionBudget budget = friction_budget(s, total);
    for (int c = 0; c < S::kTangents; ++c) budget.before[c] = Float::load(bounce.total_tangent[c]);
    if constexpr (ContactBlock<S, N>::kTwist) budget.twist_before = Float::load(bounce.total_twist);
    solve_friction(s, budget, v, after, twist_after);
    v.b = select(part, v.b, before.b);
    if constexpr (A::kMoves) v.a = select(part, v.a, before.a);
    v.store(w, s);
    for (int c = 0; c < S::kTangents; ++c) {
      select(part, after[c], budget.before[c]).store(bounce.total_tangent[c]);
      select(part, zero, Float::load(s.tangent_impulse[c])).store(s.tangent_impulse[c]);
    }
    if constexpr (ContactBlock<S, N>::kTwist) {
      select(part, twist_after, budget.twist_before).store(bounce.total_twist);
      select(part, zero, Float::load(s.twist_impulse)).store(s.twist_impulse);
    }
  }
  for (int i = 0; i < N; ++i) {
    select(part, zero, Float::load(s.impulse[i])).store(s.impulse[i]);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
