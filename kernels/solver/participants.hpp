// Participants: the contacts that take part in the impacts of a step.
//
// The substeps resolve an impact without bounce and spread it over everything that touches. Impacts
// begin where a point approaches faster than the threshold, and meets. From there they reach what
// hangs together with their bodies by contacts and joints, as far as a contact has got a share of
// them: far along a chain or deep in a cluster that is little, or nothing as yet where the order of
// the list is against it. What rests elsewhere in the world, or is pressed by a load that has just
// come, keeps what the substeps found.
#pragma once

#include "kernels/rows/bounce_totals.hpp"
#include "kernels/solver/body_numbers.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kSharedImpact = Real(1.0 / 128);  // of the impact's speed: a share of it
inline constexpr Real kTouch = Real(1.0 / 64);          // of the margin: a gap that counts as none

// Finds the lanes in which impacts begin at a block, whether or not it bounces. Returns how fast it
// approached, 0 elsewhere.
template <class S, int N>
MW_INLINE Float find_impacts(const ContactBlock<S, N>& s, Bounce<S, N>& bounce) {
  const Float zero(Real(0));
  Float fastest = zero;
  for (int i = 0; i < N; ++i) {
    const Float impact = Float::load(bounce.impact[i]);
    const Mask meets = (zero < impact) & (zero < Float::load(bounce.total[i]));
    fastest = max(select(meets, impact, zero), fastest);
  }
  fastest = select(mask_from_bits(s.mask), fastest, zero);
  bounce.participants = bits(zero < fastest);
  fastest.store(bounce.reached);
  return fastest;
}

// Adds the lanes of `lanes` in which an impact at its bodies has reached a block. Returns how fast
// that was, 0 elsewhere.
template <bool kDense, class S, int N, class A>
MW_INLINE Float reach_block(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                            Bounce<S, N>& bounce, unsigned lanes) {
  const Float zero(Real(0)), touch(t.margin * kTouch);
  const Float speed = largest_number<kDense>(t, w, s, lanes), least = speed * Float(kSharedImpact);
  lanes &= bits(zero < speed);
  if (lanes == 0) return zero;
  const Float substeps(static_cast<Real>(t.substeps));
  Float gaps[N];
  for (int i = 0; i < N; ++i) gaps[i] = Float::load(s.separation[i]);
  moved_apart<kDense>(w, s, gaps);
  Mask part = zero < zero;
  for (int i = 0; i < N; ++i) {
    const Float mass = Float::load(s.mass[i]), share = mass * least;
    const Float rests = substeps * Float::load(bounce.carried[i]);
    // More impulse than resting takes; or none to speak of, but it touches.
    const Mask idle = (zero < mass) & (rests <= share) & (gaps[i] < touch);
    part = part | (rests + share < Float::load(bounce.total[i])) | idle;
  }
  const unsigned reached = bits(part) & lanes;
  bounce.participants |= reached;
  const Mask joins = mask_from_bits(reached);
  select(joins, speed, Float::load(bounce.reached)).store(bounce.reached);
  return select(joins, speed, zero);
}

// Joints pass impacts on.
inline void pass_through_joints(const Constants& t, const Work& w, unsigned& grown) {
  for (int i = 0; i < t.parts; ++i) {
    const auto& part = t.part[i];
    const auto moves = [&](int body) { return body < t.bodies && !t.body[body].kinematic; };
    if (part.force || !moves(part.body_a) || !moves(part.body_b)) continue;
    Real *a = number_of(w, part.body_a), *b = number_of(w, part.body_b);
    const Float of_a = Float::load(a), of_b = Float::load(b), most = max(of_a, of_b);
    grown |= bits(of_a < most) | bits(of_b < most);
    most.store(a), most.store(b);
  }
}

// Finds the lanes in which each block takes part. Returns all of them.
template <class S, bool kDense>
unsigned find_participants(const Constants& t, Work& w) {
  const Float zero(Real(0));
  unsigned open = 0;
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
    auto& bounce = bounce_at<S, N>(list, i);
    const Float speed = find_impacts(s, bounce);
    if (bounce.participants == 0) return;
    if (open == 0) clear_numbers(t, w);
    open |= bounce.participants;
    raise_numbers<kDense>(t, w, s, speed, bounce.participants);
  });
  if (open == 0) return 0;
  while (open != 0) {
    unsigned grown = 0;
    pass_through_joints(t, w, grown);
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      auto& bounce = bounce_at<S, N>(list, i);
      const unsigned before = bounce.participants, lanes = open & s.mask & ~before;
      if (lanes == 0) return;
      const Float speed = reach_block<kDense>(t, w, s, bounce, lanes);
      const unsigned joins = bounce.participants & ~before;
      raise_numbers<kDense>(t, w, s, speed, joins);
      grown |= joins;
    });
    open &= grown;
  }
  unsigned active = 0;
  for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>&, int i, BlockList& list) {
    auto& bounce = bounce_at<S, N>(list, i);
    bounce.participants &= bits(zero < Float::load(bounce.restitution));
    active |= bounce.participants;
  });
  return active;
}

// Takes the participants' impulses back, and keeps what the substeps found.
template <bool kDense, class S, int N, class A>
MW_INLINE void take_back(const Constants& t, Work& w, SidedBlock<S, N, A>& s,
                         Bounce<S, N>& bounce) {
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
  if (t.has_friction) {
    Float f[2] = {-Float::load(bounce.total_tangent[0]), Real(0)}, twist(Real(0));
    if constexpr (S::kTangents == 2) f[1] = -Float::load(bounce.total_tangent[1]);
    if constexpr (ContactBlock<S, N>::kTwist) twist = -Float::load(bounce.total_twist);
    apply_friction(s, f, twist, v);
  }
  keep_other_lanes_of_sides(part, before, v);
  v.store(w, s);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
