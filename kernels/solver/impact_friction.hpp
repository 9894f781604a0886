// Friction of impacts, which keeps the speeds with which the points leave.
//
// Friction turns bodies, and so changes the speeds along the normals of all their contacts. Rounds
// of friction and normal impulses follow the impacts: points that were struck keep the speeds that
// the impacts gave them, and other contacts of the same bodies approach no faster than before. A
// block takes part in a round only where one of its bodies has changed since, so that what happens
// elsewhere in a world decides nothing.
#pragma once

#include "kernels/solver/impacts.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kFrictionRounds = 32;
// Of an impulse: changes that no other block answers.
inline constexpr Real kFrictionTolerance = sizeof(Real) == 4 ? Real(1e-5) : Real(1e-11);

// Chooses the speeds to keep and the least impulses. Friction of participants starts from zero:
// what the substeps found was returned with the normal impulses.
template <bool kDense, class S, int N, class A>
MW_INLINE void hold_speeds(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                           Bounce<S, N>& bounce, unsigned active) {
  if ((s.mask & active) == 0) return;
  const Mask part = mask_from_bits(bounce.participants);
  const Float zero(Real(0)), never(Real(-1e30)), touch(t.margin * kTouch);
  const RowVelocities<S, A, kDense> v(w, s);
  Float speed[N], gaps[N];
  normal_speeds(s, v, speed);
  for (int i = 0; i < N; ++i) gaps[i] = Float::load(s.separation[i]);
  moved_apart<kDense>(w, s, gaps);
  for (int i = 0; i < N; ++i) {
    const Float total = Float::load(bounce.total[i]);
    const Mask pressed = zero < total;
    const Mask there = (part & meets(s, bounce, i)) | (!part & (pressed | (gaps[i] < touch)));
    const Float kept = select(part & pressed, speed[i], min(speed[i], zero));
    select(there, kept, never).store(bounce.target[i]);
    select(part, zero, total).store(bounce.least[i]);
  }
  for (int c = 0; c < S::kTangents; ++c) {
    select(part, zero, Float::load(bounce.total_tangent[c])).store(bounce.total_tangent[c]);
  }
  select(part, zero, Float::load(bounce.total_twist)).store(bounce.total_twist);
  mark_changed<kDense>(t, w, s, bounce.participants, 0);
}

// One round over a block, in the lanes in which its bodies have changed. Returns those in which it
// has changed them.
template <bool kDense, class S, int N, class A>
MW_INLINE unsigned solve_friction_of_impact(const Constants& t, Work& w, SidedBlock<S, N, A>& s,
                                            Bounce<S, N>& bounce, unsigned open, int round) {
  open = lanes_to_play<kDense>(t, w, s, open & s.mask, round);
  if (open == 0) return 0;
  const Float zero(Real(0)), tolerance(kFrictionTolerance);
  const Mask plays = mask_from_bits(open), part = mask_from_bits(bounce.participants) & plays;
  RowVelocities<S, A, kDense> v(w, s), before = v;
  Float total[N], speed[N], d[N], after[2], twist_after(Real(0));
  for (int i = 0; i < N; ++i) total[i] = Float::load(bounce.total[i]);
  FrictionBudget budget = friction_budget(s, total);
  for (int c = 0; c < S::kTangents; ++c) budget.before[c] = Float::load(bounce.total_tangent[c]);
  if constexpr (ContactBlock<S, N>::kTwist) budget.twist_before = Float::load(bounce.total_twist);
  solve_friction(s, budget, v, after, twist_after);
  keep_other_lanes_of_sides(part, before, v);
  Float most = zero;
  for (int c = 0; c < S::kTangents; ++c) {
    after[c] = select(part, after[c], budget.before[c]);
    most = max(abs(after[c] - budget.before[c]), most);
    after[c].store(bounce.total_tangent[c]);
  }
  Mask changed = tolerance * budget.bound < most;
  if constexpr (ContactBlock<S, N>::kTwist) {
    twist_after = select(part, twist_after, budget.twist_before);
    changed = changed | (tolerance * budget.twist_bound < abs(twist_after - budget.twist_before));
    twist_after.store(bounce.total_twist);
  }
  normal_speeds(s, v, speed);
  const Float size = sum_of<N>(total);
  for (int i = 0; i < N; ++i) {
    const Float target = Float::load(bounce.target[i]), mass = Float::load(s.mass[i]);
    const Float least = Float::load(bounce.least[i]);
    const Float x = select(plays, max(fma(mass, target - speed[i], total[i]), least), total[i]);
    d[i] = x - total[i];
    changed = changed | (tolerance * max(x, size) < abs(d[i]));
    x.store(bounce.total[i]);
    couple_following(s, i, d[i], speed);
  }
  const auto slowed = v;
  apply_normal(s, d, v);
  keep_other_lanes_of_sides(plays, slowed, v);
  v.store(w, s);
  const unsigned out = bits(changed & plays);
  mark_changed<kDense>(t, w, s, out, round);
  return out;
}

template <class S, bool kDense>
void solve_friction_of_impacts(const Constants& t, Work& w, unsigned active) {
  clear_numbers<BodyNumber::round>(t, w);
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
    hold_speeds<kDense>(t, w, s, bounce_at<S, N>(list, i), active);
  });
  for (int round = 1; round <= kFrictionRounds && active != 0; ++round) {
    unsigned goes_on = 0;
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      goes_on |= solve_friction_of_impact<kDense>(t, w, s, bounce_at<S, N>(list, i), active, round);
    });
    active = goes_on;
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
