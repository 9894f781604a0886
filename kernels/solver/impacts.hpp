// Impacts: those of one time are one system, and the strongest come first.
//
// In a sweep of restitution those participants play that share no body with one which approaches
// much faster. Impacts of like strength happen at one time: solved one after the other, their order
// would show. All of a chain at once would let it answer as one body: no cradle would work. Each
// point shall leave with v' >= -e u, u < 0 its approach when the sweep began; projected
// Gauss-Seidel over all that play finds impulses p >= 0 with p (v' + e u) = 0. The energy then
// changes by sum (1 - e) p u / 2 <= 0, whatever the geometry. (Generalized reflections, as in Smith
// et al., Reflections on Simultaneous Impact, SIGGRAPH 2012, but strongest first.)
#pragma once

#include "kernels/solver/participants.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kBlockIterations = 8;    // of Gauss-Seidel inside one manifold
inline constexpr int kImpactIterations = 24;  // over all that play in a sweep, at most
// An approach below this share of the fastest at one of its bodies waits. Symmetric racks have
// ratios of 1/2, and rounding must decide nothing.
inline constexpr Real kMuchFaster = Real(0.3);
// Relative change of an impulse that no other block answers, and approach, as a share of the impact
// that has reached a block, that is left to the next step.
inline constexpr Real kImpactTolerance = sizeof(Real) == 4 ? Real(2e-6) : Real(1e-12);

// Where a point can be one of an impact: a far point has met nothing, unless the substeps say so.
template <class S, int N>
MW_INLINE Mask meets(const ContactBlock<S, N>& s, const Bounce<S, N>& bounce, int i) {
  const Float zero(Real(0));
  return (zero < Float::load(s.mass[i])) &
         (mask_from_bits(s.close[i]) | (zero < Float::load(bounce.found[i])));
}

// How fast the participants among `lanes` approach, and the speeds that their points shall leave
// with. What approaches slower than a thousandth of the threshold is left to the next step.
template <bool kDense, class S, int N, class A>
MW_INLINE void weigh_impact(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                            Bounce<S, N>& bounce, unsigned lanes, bool first) {
  const Float zero(Real(0));
  lanes &= bounce.participants;
  bounce.playing = 0;
  if (lanes == 0) return;
  const Float threshold = Float::load(bounce.threshold);
  const Float slow =
      max(threshold * Float(Real(1e-3)), Float::load(bounce.reached) * Float(kImpactTolerance));
  const Float e = Float::load(bounce.restitution);
  const RowVelocities<S, A, kDense> v(w, s);
  Float speed[N], fastest = zero;
  normal_speeds(s, v, speed);
  for (int i = 0; i < N; ++i) {
    const Mask there = meets(s, bounce, i);
    Float target = select(speed[i] < -threshold, -(e * speed[i]), zero);
    Mask hits = there & (speed[i] < -slow);
    if (first) {
      // At the moment of touch it is faster than now: v^2 = v0^2 + 2 a s0.
      const Float impact = Float::load(bounce.impact[i]);
      const Mask struck = there & (zero < impact) & (speed[i] < zero);
      target = select(struck, e * impact, target);
      hits = hits | struck;
    }
    target.store(bounce.target[i]);
    fastest = max(select(hits, -speed[i], zero), fastest);
  }
  fastest = select(mask_from_bits(lanes), fastest, zero);
  fastest.store(bounce.approach);
  bounce.playing = bits(zero < fastest);
  raise_numbers<kDense>(t, w, s, fastest, bounce.playing);
}

// Chooses which of them play, and what they start from. Returns the lanes in which this one does.
template <bool kDense, class S, int N, class A>
MW_INLINE unsigned choose_impact(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                                 Bounce<S, N>& bounce, bool first) {
  if (bounce.playing != 0) {
    const Float fastest = largest_number<kDense>(t, w, s, bounce.playing);
    bounce.playing &= bits(fastest * Float(kMuchFaster) <= Float::load(bounce.approach));
  }
  if (bounce.playing == 0 && !first) return 0;
  const Float zero(Real(0)), one(Real(1)), e = Float::load(bounce.restitution);
  const Mask part = mask_from_bits(bounce.participants), plays = mask_from_bits(bounce.playing);
  for (int i = 0; i < N; ++i) {
    const Float total = Float::load(bounce.total[i]);
    // The substeps' impulses, scaled up, are the answer already when nothing else took part.
    const Mask struck = plays & (zero < Float::load(bounce.impact[i]));
    const Float guess = first ? select(struck, (one + e) * total, zero) : zero;
    guess.store(bounce.played[i]);
    // They were taken back: what the impacts add up to replaces them.
    if (first) select(part, zero, total).store(bounce.total[i]);
  }
  return bounce.playing;
}

// One round over a block that plays in some of `lanes`. Returns those in which it has changed.
template <bool kDense, class S, int N, class A>
MW_INLINE unsigned play_impact(const Constants& t, Work& w, SidedBlock<S, N, A>& s,
                               Bounce<S, N>& bounce, unsigned lanes, int round) {
  const bool first = round == 0;
  lanes &= bounce.playing;
  if (!first) lanes = lanes_to_play<kDense>(t, w, s, lanes, round);
  if (lanes == 0) return 0;
  const Float zero(Real(0)), one(Real(1)), tolerance(kImpactTolerance);
  const Mask plays = mask_from_bits(lanes);
  RowVelocities<S, A, kDense> v(w, s), before = v;
  Float speed[N], target[N], played[N], mass[N], inv_mass[N], d[N];
  normal_speeds(s, v, speed);
  for (int i = 0; i < N; ++i) {
    mass[i] = select(meets(s, bounce, i), Float::load(s.mass[i]), zero);
    inv_mass[i] = one / select(zero < mass[i], mass[i], one);
    target[i] = Float::load(bounce.target[i]);
    played[i] = Float::load(bounce.played[i]);
    d[i] = first ? played[i] : zero;
  }
  if (first) {
    for (int i = 0; i < N; ++i) couple_all(s, i, d[i], speed);
    for (int i = 0; i < N; ++i) speed[i] = fma(inv_mass[i], d[i], speed[i]);
  }
  Mask changed = zero < zero;
  for (int k = 0; k < (N == 1 ? 1 : kBlockIterations); ++k) {
    for (int i = 0; i < N; ++i) {
      const Float x = max(fma(mass[i], target[i] - speed[i], played[i]), zero);
      const Float change = select(zero < mass[i], x - played[i], zero);
      if (k == 0) changed = changed | (tolerance * max(x, played[i]) < abs(change));
      played[i] = played[i] + change;
      d[i] = d[i] + change;
      speed[i] = fma(inv_mass[i], change, speed[i]);
      couple_all(s, i, change, speed);
    }
  }
  apply_normal(s, d, v);
  keep_other_lanes_of_sides(plays, before, v);
  v.store(w, s);
  for (int i = 0; i < N; ++i) {
    const Float total = Float::load(bounce.total[i]);
    select(plays, played[i], Float::load(bounce.played[i])).store(bounce.played[i]);
    select(plays, total + d[i], total).store(bounce.total[i]);
  }
  const unsigned out = first ? lanes : bits(changed) & lanes;
  mark_changed<kDense>(t, w, s, out, round);
  return out;
}

// Plays the impacts of the lanes of `active`, sweep after sweep, until nothing approaches any more.
template <class S, bool kDense>
void play_impacts(const Constants& t, Work& w, unsigned active) {
  for (int sweep = 0; sweep < t.restitution_sweeps && active != 0; ++sweep) {
    const bool first = sweep == 0;
    clear_numbers(t, w);
    clear_numbers<BodyNumber::round>(t, w);
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      weigh_impact<kDense>(t, w, s, bounce_at<S, N>(list, i), active, first);
    });
    unsigned chosen = 0;  // lanes in which some play
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      chosen |= choose_impact<kDense>(t, w, s, bounce_at<S, N>(list, i), first);
    });
    active = chosen;
    unsigned open = active;
    for (int k = 0; k < kImpactIterations && open != 0; ++k) {
      unsigned goes_on = 0;
      for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
        goes_on |= play_impact<kDense>(t, w, s, bounce_at<S, N>(list, i), open, k);
      });
      open = goes_on;
    }
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
