// Strikes: impacts of several bodies in one substep are one system, with or without bounce.
//
// After one sweep over the contacts, the order of the rows decides how a ball that hits two others
// shares its momentum. So where an impact has reached a contact, more sweeps follow in the bias and
// relax passes, forward and backward, until no impulse changes by more than a tolerance. A block
// is solved again only in the lanes in which one of its bodies has changed since, so that bodies
// elsewhere in a world have no influence. The tolerance grows from sweep to sweep, up to the whole
// impulse in the last.
//
// An impact is a point that approaches faster than strike_speed when the step begins
// (rows/prepare.hpp), at a body with several points of contact. Impulses or speeds within a
// substep cannot distinguish it from a load whose stored impulse was lost. From there it spreads
// to contacts that share a body. In later substeps, blocks that it has reached are struck again
// where they change as much: warm starting repeats the impulse of the impact, and gaps close that
// the impact has set moving. Impulses of an impact in the last substep are not kept as warm start
// (rows/stored_impulses.hpp); their sign marks the block as struck (rows/contact_cache.hpp).
#pragma once

#include "kernels/motion/integrate.hpp"
#include "kernels/rows/block_impulses.hpp"
#include "kernels/rows/contact.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// What gravity gives in so many passes is no impact.
inline constexpr Real kPassesOfRest = Real(2);

// Of the whole world, so that it is known before contacts are.
template <class S>
void find_strike_speeds(const Constants& t, const Group& g, Work& w) {
  w.struck = 0;
  if (t.impact_sweeps == 0) return;
  Float pull2(Real(0));
  for (int b = 0; t.has_gravity && b < (t.uniform_gravity ? 1 : t.bodies); ++b) {
    const LaneNumber* pull = constants_of_body(g, b).gravity;
    Float sum = Float(pull[0]) * Float(pull[0]);
    for (int c = 1; c < S::kDim; ++c) sum = fma(Float(pull[c]), Float(pull[c]), sum);
    pull2 = max(sum, pull2);
  }
  max(sqrt(pull2) * Float(t.dt * kPassesOfRest), Float(t.strike_speed)).store(w.strike_speed);
}

// visit(body, lanes) of the bodies that a block moves. What is kinematic passes nothing on.
template <class S, bool kDense, class A, int N, class Visit>
MW_INLINE void for_each_body(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                             std::uint32_t lanes, Visit visit) {
  const auto moved = [&](int body, std::uint32_t in) {
    if (!t.body[body].kinematic) visit(body, in);
  };
  if constexpr (kDense) {
    moved(s.body_b, lanes);
    if constexpr (A::kMoves) moved(s.body_a, lanes);
  } else {
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes), base = w.velocity_base[lane];
      moved((s.offset_b[lane] - base) / S::kRow, 1u << lane);
      if constexpr (A::kMoves) moved((s.offset_a[lane] - base) / S::kRow, 1u << lane);
    }
  }
}

// Leaves out strikes at bodies with one point of contact: there is nothing to share.
template <class S, bool kDense>
__attribute__((noinline)) void keep_shared_strikes(const Constants& t, Work& w) {
  std::uint32_t strikes = 0;
  for_each_block<S>(
      w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int, BlockList&) { strikes |= s.strikes; });
  if (strikes == 0) return;
  std::uint32_t *one = w.stirred, *several = w.stirred + t.bodies;
  for (int b = 0; b < t.bodies; ++b) one[b] = several[b] = 0;
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int, BlockList&) {
    for_each_body<S, kDense>(t, w, s, s.mask, [&](int body, std::uint32_t lanes) {
      several[body] |= N > 1 ? lanes : lanes & one[body];
      one[body] |= lanes;
    });
  });
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int, BlockList&) {
    std::uint32_t shared = 0;
    for_each_body<S, kDense>(t, w, s, s.strikes, [&](int body, std::uint32_t lanes) {
      shared |= several[body] & lanes;
    });
    s.strikes = shared;
  });
}

// Before the first block of a bias pass.
template <class S, bool kDense>
void begin_strikes(const Constants& t, Work& w) {
  if (w.substep == 0 && w.sweep == 0) keep_shared_strikes<S, kDense>(t, w);
  w.struck_before = w.sweep > 0 ? kAllLanes : 0;
  if (w.sweep == 0) w.struck = 0;
  ++w.sweep;
}

// Lanes in which a body has changed: `now` in this round, `before` in the last.
struct Stirred {
  std::uint32_t *now, *before;
};
MW_INLINE Stirred stirred_of(const Constants& t, const Work& w) {
  return {w.stirred, w.stirred + t.bodies};
}
inline void next_round(const Constants& t, const Work& w) {
  const Stirred at = stirred_of(t, w);
  for (int b = 0; b < t.bodies; ++b) at.before[b] = at.now[b], at.now[b] = 0;
}

// A block in some lanes only: its other lanes move nothing, in rows the dummy.
template <class S, int N, class A, class Change>
MW_INLINE void in_lanes(const Constants& t, Work& w, SidedBlock<S, N, A>& s, std::uint32_t lanes,
                        Change change) {
  const std::uint32_t mask = s.mask;
  const Ints offset_a = Ints::load(s.offset_a), offset_b = Ints::load(s.offset_b);
  const Ints dummy = Ints::load(w.velocity_base) + Ints(t.bodies * S::kRow);
  select(lanes, offset_a, dummy).store(s.offset_a);
  select(lanes, offset_b, dummy).store(s.offset_b);
  s.mask = lanes;
  change();
  offset_a.store(s.offset_a), offset_b.store(s.offset_b);
  s.mask = mask;
}

// Solves a block once more in these lanes. Returns those in which it has changed.
template <bool kDense, class S, int N, class A>
std::uint32_t solve_struck(const Constants& t, Work& w, SidedBlock<S, N, A>& s, std::uint32_t lanes,
                           BlockImpulses<S, N>& before, Pass pass, Real tolerance) {
  const Mask plays = mask_from_bits(lanes);
  before.lanes |= lanes;
  const std::uint32_t unsure = s.unsure & ~lanes, struck = s.struck | lanes;
  s.strikes |= lanes;
  s.unsure &= lanes, s.struck = struck;
  BlockImpulses<S, N> impulses;
  impulses.load(s);
  in_lanes(t, w, s, lanes, [&] {
    if (pass == Pass::bias) {
      solve_block<kDense, Pass::bias>(t, w, s);
    } else {
      solve_block<kDense, Pass::relax>(t, w, s);
    }
  });
  impulses.restore(plays, s);
  s.unsure |= unsure, s.struck = struck;
  const Float share(tolerance), speed = Float::load(w.strike_speed);
  Mask changed = mask_from_bits(0);
  for (int i = 0; i < N; ++i) {
    const Float after = Float::load(s.impulse[i]), was = impulses.normal[i];
    const Float size = fma(speed, Float::load(s.mass[i]), max(after, was));
    changed = changed | (share * size < abs(after - was));
  }
  return bits(changed & plays);
}

// Takes down what sweeps begin with.
template <class S, bool kDense>
void open_strikes(const Constants& t, Work& w) {
  for_each_register<S, kDense>(t, w, [&](int at, Float, Float) {
    Float::load(w.velocity + at).store(w.velocity_before + at);
  });
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
    impulses_before<S, N>(list, i).load(s);
  });
}
// Applies what the sweeps have changed once more at once, since each sweep has rounded velocities:
// bodies that keep hitting each other would lose their momentum.
template <class S, bool kDense>
void close_strikes(const Constants& t, Work& w) {
  for_each_register<S, kDense>(t, w, [&](int at, Float, Float) {
    Float::load(w.velocity_before + at).store(w.velocity + at);
  });
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
    const auto& before = impulses_before<S, N>(list, i);
    if (before.lanes == 0) return;
    in_lanes(t, w, s, before.lanes, [&] {
      auto v = velocities_of<kDense>(w, s);
      before.apply_changes(s, t.has_friction, v);
      v.store(w, s);
    });
  });
  put_velocity<S, kDense>(w, w.velocity, t.bodies,
                          {zero_of<typename S::Vec>(), zero_of<typename S::Ang>()});
}

template <class S, bool kDense>
__attribute__((noinline)) void settle_strikes(const Constants& t, Work& w, Pass pass) {
  const Stirred at = stirred_of(t, w);
  const auto stir = [&](int body, std::uint32_t lanes) { at.now[body] |= lanes; };
  for (int b = 0; b < t.bodies; ++b) at.now[b] = 0;
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int, BlockList&) {
    if (s.struck != 0) for_each_body<S, kDense>(t, w, s, s.struck, stir);
  });
  open_strikes<S, kDense>(t, w);
  const std::uint32_t struck = w.struck;
  w.settles = true;
  std::uint32_t open = struck;
  Real tolerance = t.strike_tolerance;
  for (int round = 1; round <= t.impact_sweeps && open != 0; ++round) {
    next_round(t, w);
    tolerance *= t.strike_growth;
    std::uint32_t goes_on = 0;
    for_each_list<S>(w, [&]<int N, class A>(BlockList& list) {
      for (int k = 0; k < list.count; ++k) {
        const int i = round % 2 == 0 ? k : list.count - 1 - k;
        auto& s = block_at<SidedBlock<S, N, A>>(list, i);
        std::uint32_t lanes = 0;
        for_each_body<S, kDense>(t, w, s, open & s.mask, [&](int body, std::uint32_t in) {
          lanes |= (at.now[body] | at.before[body]) & in;
        });
        if (lanes == 0) continue;
        auto& before = impulses_before<S, N>(list, i);
        const std::uint32_t out = solve_struck<kDense>(t, w, s, lanes, before, pass, tolerance);
        for_each_body<S, kDense>(t, w, s, out, stir);
        goes_on |= out;
      }
    });
    open = goes_on;
  }
  close_strikes<S, kDense>(t, w);
  w.struck = struck, w.settles = false;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
