// Restitution: impacts propagate pair by pair after the substeps.
//
// The substeps resolve an impact without bounce and spread it over everything that touches. So for
// the contacts that took part in an impact this pass first takes their normal impulses back, and
// then plays the impacts one manifold after the other, each v' = -e v, until nothing approaches
// any more (or restitution_sweeps is reached). A Newton's cradle then sends out as many balls as
// came in. The first impact of a contact uses the speed at the moment of touch,
// v^2 = v0^2 + 2 a s0, so that a bouncing ball reaches e^2 of its height at any time step.
// Resting contacts (slower than the threshold) keep what the substeps found.
#pragma once

#include "kernels/rows/contact.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kBlockIterations = 8;  // of Gauss-Seidel inside one manifold

// Every other row follows when row k changes by d.
template <class S, int N>
MW_INLINE void couple_all(const ContactBlock<S, N>& s, int k, Float d, Float* speed) {
  for (int j = 0; j < k; ++j) {
    const int at = j * N - j * (j + 1) / 2 + (k - j - 1);
    speed[j] = fma(Float::load(s.cross_k[at]), d, speed[j]);
  }
  couple_following(s, k, d, speed);
}

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

// Finds the lanes of a block that took part in an impact.
template <class S, int N>
MW_INLINE void find_participants(const Constants& t, const ContactBlock<S, N>& s,
                                 Bounce<S, N>& bounce) {
  const Float zero(Real(0)), threshold(t.restitution_threshold);
  const Float substeps(static_cast<Real>(t.substeps));
  Mask part = zero < zero;
  for (int i = 0; i < N; ++i) {
    const Float total = Float::load(bounce.total[i]);
    // More impulse than resting takes, by what changes the speed by the threshold.
    const Float extra = fnma(substeps, Float::load(bounce.carried[i]), total);
    part = part | (Float::load(s.mass[i]) * threshold < extra) |
           ((zero < Float::load(bounce.impact[i])) & (zero < total));
  }
  part = part & (zero < Float::load(bounce.restitution)) & mask_from_bits(s.mask);
  bounce.participants = bits(part);
}

// Takes their normal impulses back, and keeps what the substeps found.
template <bool kDense, class S, int N, class A>
MW_INLINE void take_back(Work& w, SidedBlock<S, N, A>& s, Bounce<S, N>& bounce) {
  Float d[N];
  for (int i = 0; i < N; ++i) {
    const Float total = Float::load(bounce.total[i]);
    total.store(bounce.found[i]);
    d[i] = -total;
  }
  for (int c = 0; c < S::kTangents; ++c) {
    Float::load(bounce.total_tangent[c]).store(bounce.found_tangent[c]);
  }
  Float::load(bounce.total_twist).store(bounce.found_twist);
  if (bounce.participants == 0) return;
  const Mask part = mask_from_bits(bounce.participants);
  RowVelocities<S, A, kDense> v(w, s), before = v;
  apply_normal(s, d, v);
  v.b = select(part, v.b, before.b);
  if constexpr (A::kMoves) v.a = select(part, v.a, before.a);
  v.store(w, s);
}

// Plays one impact of a manifold. Returns the lanes in which one happened.
template <bool kDense, class S, int N, class A>
MW_INLINE unsigned play_impact(const Constants& t, Work& w, SidedBlock<S, N, A>& s,
                               Bounce<S, N>& bounce, bool first) {
  if (bounce.participants == 0) return 0;
  const Float zero(Real(0)), one(Real(1)), threshold(t.restitution_threshold);
  const Float e = Float::load(bounce.restitution);
  const Float rest = threshold * Real(-1e-3);  // slower approaches are left to the next step
  RowVelocities<S, A, kDense> v(w, s), before = v;
  Float speed[N], target[N], total[N], impulse[N];
  normal_speeds(s, v, speed);
  Mask needed = zero < zero;
  for (int i = 0; i < N; ++i) {
    total[i] = first ? zero : Float::load(bounce.total[i]);
    const Mask there = zero < Float::load(s.mass[i]);
    target[i] = select(speed[i] < -threshold, -(e * speed[i]), zero);
    Mask hits = there & (speed[i] < rest);
    impulse[i] = zero;
    if (first) {
      const Float impact = Float::load(bounce.impact[i]);
      const Mask struck = there & (zero < impact) & (speed[i] < zero);
      target[i] = select(struck, e * impact, target[i]);
      // The substeps' impulses, scaled up, are the answer already when nothing else took part.
      impulse[i] = select(struck, (one + e) * Float::load(bounce.total[i]), zero);
      hits = hits | struck;
    }
    needed = needed | hits;
  }
  needed = needed & mask_from_bits(bounce.participants);
  const unsigned lanes = bits(needed);
  if (lanes != 0) {
    for (int i = 0; i < N; ++i) couple_all(s, i, impulse[i], speed);
    for (int i = 0; i < N; ++i) {
      speed[i] = fma(one / select(zero < Float::load(s.mass[i]), Float::load(s.mass[i]), one),
                     impulse[i], speed[i]);
    }
    for (int round = 0; round < (N == 1 ? 1 : kBlockIterations); ++round) {
      for (int i = 0; i < N; ++i) {
        const Float mass = Float::load(s.mass[i]);
        const Float x = max(fma(mass, target[i] - speed[i], impulse[i]), zero);
        const Float d = select(zero < mass, x - impulse[i], zero);
        impulse[i] = impulse[i] + d;
        speed[i] = fma(one / select(zero < mass, mass, one), d, speed[i]);
        couple_all(s, i, d, speed);
      }
    }
    apply_normal(s, impulse, v);
    v.b = select(needed, v.b, before.b);
    if constexpr (A::kMoves) v.a = select(needed, v.a, before.a);
    v.store(w, s);
  }
  // The totals of the substeps were taken back: what the impacts add up to replaces them.
  if (lanes != 0 || first) {
    const Mask part = mask_from_bits(bounce.participants);
    for (int i = 0; i < N; ++i) {
      const Float sum = select(needed, total[i] + impulse[i], total[i]);
      select(part, sum, Float::load(bounce.total[i])).store(bounce.total[i]);
    }
  }
  return lanes;
}

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
