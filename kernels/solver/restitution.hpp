// Restitution: after the substeps the impacts of the step are played.
//
// The substeps resolve an impact without bounce and spread it over everything that touches. So the
// contacts that took part in one (participants.hpp) first give their impulses back, and then
// play their impacts, v' = -e v, until nothing approaches any more or restitution_sweeps is reached
// (impacts.hpp). A Newton's cradle then sends out as many balls as came in. The first impact of a
// contact uses the speed at the moment of touch, v^2 = v0^2 + 2 a s0, so that a bouncing ball
// reaches e^2 of its height at any time step. Resting contacts (slower than the threshold) keep
// what the substeps found. Friction follows, which keeps the speeds along the normals, and a
// balance of energy (energy.hpp).
#pragma once

#include "kernels/solver/impacts.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Rounds of friction and normal impulses in turn. One sweep of friction alone would change the
// speeds with which the points leave: a flat box would be thrown aside and spin.
inline constexpr int kFrictionRounds = 8;

// The speeds with which the points leave, for friction to keep; and friction begins anew.
template <bool kDense, class S, int N, class A>
MW_INLINE void hold_speeds(const Work& w, const SidedBlock<S, N, A>& s, Bounce<S, N>& bounce) {
  if (bounce.participants == 0) return;
  const Mask part = mask_from_bits(bounce.participants);
  const Float zero(Real(0));
  const RowVelocities<S, A, kDense> v(w, s);
  Float speed[N];
  normal_speeds(s, v, speed);
  for (int i = 0; i < N; ++i) {
    const Mask pressed = zero < Float::load(bounce.total[i]);
    select(pressed, speed[i], min(speed[i], zero)).store(bounce.target[i]);
  }
  for (int c = 0; c < S::kTangents; ++c) {
    select(part, zero, Float::load(bounce.total_tangent[c])).store(bounce.total_tangent[c]);
  }
  if constexpr (ContactBlock<S, N>::kTwist) {
    select(part, zero, Float::load(bounce.total_twist)).store(bounce.total_twist);
  }
}

// Friction of the impacts, within mu times all normal impulse of the step, and the normal impulses
// that it takes to leave as fast as before.
template <bool kDense, class S, int N, class A>
MW_INLINE void rub_impact(Work& w, SidedBlock<S, N, A>& s, Bounce<S, N>& bounce) {
  if (bounce.participants == 0) return;
  const Mask part = mask_from_bits(bounce.participants);
  const Float zero(Real(0));
  RowVelocities<S, A, kDense> v(w, s), before = v;
  Float total[N], speed[N], d[N], after[2], twist_after(Real(0));
  for (int i = 0; i < N; ++i) total[i] = Float::load(bounce.total[i]);
  FrictionBudget budget = friction_budget(s, total);
  for (int c = 0; c < S::kTangents; ++c) budget.before[c] = Float::load(bounce.total_tangent[c]);
  if constexpr (ContactBlock<S, N>::kTwist) budget.twist_before = Float::load(bounce.total_twist);
  solve_friction(s, budget, v, after, twist_after);
  normal_speeds(s, v, speed);
  for (int i = 0; i < N; ++i) {
    const Float mass = select(meets(s, bounce, i), Float::load(s.mass[i]), zero);
    const Float x = max(fma(mass, Float::load(bounce.target[i]) - speed[i], total[i]), zero);
    d[i] = select(zero < mass, x - total[i], zero);
    couple_following(s, i, d[i], speed);
    select(part, total[i] + d[i], total[i]).store(bounce.total[i]);
  }
  apply_normal(s, d, v);
  keep_other_lanes_of_sides(part, before, v);
  v.store(w, s);
  for (int c = 0; c < S::kTangents; ++c) {
    select(part, after[c], budget.before[c]).store(bounce.total_tangent[c]);
  }
  if constexpr (ContactBlock<S, N>::kTwist) {
    select(part, twist_after, budget.twist_before).store(bounce.total_twist);
  }
}

template <class S, bool kDense>
void rub_impacts(Work& w) {
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
    hold_speeds<kDense>(w, s, bounce_at<S, N>(list, i));
  });
  for (int round = 0; round < kFrictionRounds; ++round) {
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      rub_impact<kDense>(w, s, bounce_at<S, N>(list, i));
    });
  }
}

// Nothing of an impact is carried into the next step's warm start.
template <bool kFriction, class S, int N>
MW_INLINE void finish_impact(ContactBlock<S, N>& s, const Bounce<S, N>& bounce) {
  if (bounce.participants == 0) return;
  const Mask part = mask_from_bits(bounce.participants);
  const auto drop = [&](Real* x) { select(part, Float(Real(0)), Float::load(x)).store(x); };
  for (int i = 0; i < N; ++i) drop(s.impulse[i]);
  if constexpr (kFriction) {
    for (int c = 0; c < S::kTangents; ++c) drop(s.tangent_impulse[c]);
    if constexpr (ContactBlock<S, N>::kTwist) drop(s.twist_impulse);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
