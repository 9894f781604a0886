// What the solver's blocks hold after a step: impulses, which bodies touch, penetration.
//
// A pair that is asleep has no block. Its contacts are found again where it sleeps, and each of its
// impulses is what it will wake with, times the number of substeps: what a step of it would take.
#pragma once

#include "kernels/data/pair_keys.hpp"
#include "kernels/observe/contact_forces.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/rows/body_rows.hpp"
#include "kernels/rows/contact_block.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Rows of a block's totals: the points' normal impulses, then friction, then twist.
template <class S, int N>
inline constexpr int kTotals = N + S::kTangents + 1;
template <class S, int N>
inline constexpr int kPlaces = N* S::kDim + 1;

// visit(block, index, list) in the order of the solver; inside a lane that is the order of keys,
// whatever the layout.
template <class S, class Visit>
void for_each_observed(Work& w, Visit visit) {
  for (int id = 0; id < kLists; ++id) {
    const BlockList& list = w.blocks[id];
    for (int i = 0; i < list.count; ++i) {
      if (is_multi(static_cast<ListId>(id))) {
        visit(block_at<ContactBlock<S, S::kMulti>>(list, i), i, id);
      } else {
        visit(block_at<ContactBlock<S, 1>>(list, i), i, id);
      }
    }
  }
}

template <class S>
void accumulate_totals(const Constants& t, const Group&, kernels::Scratch* scratch,
                       const ObserverView& o) {
  Work& w = work_of(scratch);
  for_each_observed<S>(w, [&](auto& s, int index, int id) {
    constexpr int N = std::remove_reference_t<decltype(s)>::kPoints;
    Real* to = o.totals[id] + index * kTotals<S, N> * kLanes;
    const auto add = [&](const Real* from) {
      Float x = Float::load(from);
      if (w.substep > 0) x = x + Float::load(to);
      x.store(to);
      to += kLanes;
    };
    for (int i = 0; i < N; ++i) add(s.impulse[i]);
    if (!t.has_friction) return;
    for (int c = 0; c < S::kTangents; ++c) add(s.tangent_impulse[c]);
    if constexpr (std::remove_reference_t<decltype(s)>::kTwist) add(s.twist_impulse);
  });
}

// Impulses of a block over a pass.
template <class S, int N>
struct Totals {
  Float impulse[N], sum = Float(Real(0));
  typename S::Vec friction = zero_of<typename S::Vec>();
  Float twist = Float(Real(0));
};

template <class S, int N>
MW_INLINE void set_friction(const ContactBlock<S, N>& s, Float first, Float second,
                            Totals<S, N>& out) {
  const auto tangent = load_as<typename S::Vec>(s.tangent[0]);
  out.friction = tangent * first;
  if constexpr (S::kDim == 3) {
    out.friction = fma(cross(load_as<Vec3>(s.normal[0]), tangent), second, out.friction);
  }
}

template <class S, int N, bool kAsleep>
MW_INLINE Totals<S, N> totals_of(const Constants& t, const Work& w, const ContactBlock<S, N>& s,
                                 int index, int id, const ObserverView& o) {
  constexpr bool kTwist = ContactBlock<S, N>::kTwist;
  constexpr int kSecond = S::kTangents - 1;
  Totals<S, N> out;
  if constexpr (kAsleep) {
    const Float substeps(static_cast<Real>(t.passes * t.substeps));
    for (int i = 0; i < N; ++i) out.impulse[i] = Float::load(s.impulse[i]) * substeps;
    if (t.has_friction) {
      set_friction(s, Float::load(s.tangent_impulse[0]) * substeps,
                   Float::load(s.tangent_impulse[kSecond]) * substeps, out);
      if constexpr (kTwist) out.twist = Float::load(s.twist_impulse) * substeps;
    }
  } else if (t.has_restitution) {
    const auto& bounce = bounce_at<S, N>(w.blocks[id], index);
    for (int i = 0; i < N; ++i) out.impulse[i] = Float::load(bounce.total[i]);
    if (t.has_friction) {
      set_friction(s, Float::load(bounce.total_tangent[0]),
                   Float::load(bounce.total_tangent[kSecond]), out);
      if constexpr (kTwist) out.twist = Float::load(bounce.total_twist);
    }
  } else {
    const Real* from = o.totals[id] + index * kTotals<S, N> * kLanes;
    for (int i = 0; i < N; ++i) out.impulse[i] = Float::load(from + i * kLanes);
    if (t.has_friction) {
      set_friction(s, Float::load(from + N * kLanes), Float::load(from + (N + kSecond) * kLanes),
                   out);
      if constexpr (kTwist) out.twist = Float::load(from + (N + S::kTangents) * kLanes);
    }
  }
  for (int i = 0; i < N; ++i) out.sum = i == 0 ? out.impulse[0] : out.sum + out.impulse[i];
  return out;
}

// Features of a manifold's points are told apart by their quarter about its middle, as in contacts.
template <class S, int N>
class Features {
 public:
  Features(const ContactBlock<S, N>& s, const Real* codes, int lane)
      : s_(s), lane_(lane), code_(static_cast<std::int32_t>(codes[lane]) * 4) {
    for (int i = 0; N > 1 && i < N; ++i) {
      if (!(Real(0) < s.mass[i][lane])) continue;
      x_ += s.feature_x[i][lane], y_ += s.feature_y[i][lane], points_ += 1;
    }
  }
  std::int32_t of(int point) const {
    if constexpr (N == 1) return code_;
    return code_ + (s_.feature_x[point][lane_] * points_ > x_ ? 1 : 0) +
           (s_.feature_y[point][lane_] * points_ > y_ ? 2 : 0);
  }

 private:
  const ContactBlock<S, N>& s_;
  int lane_;
  std::int32_t code_;
  Real x_ = 0, y_ = 0, points_ = 0;
};

// The point among the first `stored` of a lane, which earlier passes of the step have stored;
// nullptr: there is none.
inline kernels::ContactImpulse<Real>* same_point(const ObserverView& o, int lane, Real stored,
                                                 std::int32_t key, std::int32_t feature) {
  const auto count = static_cast<std::int32_t>(stored);
  auto* const first = o.contacts + lane * o.room;
  for (auto* p = first; p != first + (count < o.room ? count : o.room); ++p) {
    if (p->key == key && p->feature == feature) return p;
  }
  return nullptr;
}

// The friction of a manifold acts at its middle; each point reports the share that its normal
// impulse has. Impulses of later passes are added to the point that the first of them found.
template <class S, int N>
void put_contacts(const ContactBlock<S, N>& s, const Totals<S, N>& total, const Real* places,
                  std::uint32_t lanes, const Real* stored, const ObserverView& o) {
  constexpr int kDim = S::kDim;
  const Float zero(Real(0)), one(Real(1));
  const Float per_impulse = one / select(zero < total.sum, total.sum, one);
  alignas(64) Real impulse[N][kLanes], friction[N][kDim][kLanes], twist[N][kLanes];
  for (int i = 0; i < N; ++i) {
    const Float share = total.impulse[i] * per_impulse;
    total.impulse[i].store(impulse[i]);
    store(friction[i][0], total.friction * share);
    (total.twist * share).store(twist[i]);
  }
  Real* count = rows_for(o, Observer::contacts);
  for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
    const int l = __builtin_ctz(m);
    const Features<S, N> features(s, places + N * kDim * kLanes, l);
    for (int i = 0; i < N; ++i) {
      const bool close = ((s.close[i] >> l) & 1u) != 0;
      if (!(Real(0) < s.mass[i][l]) || !(close || Real(0) < impulse[i][l])) continue;
      const std::int32_t feature = features.of(i);
      if (auto* const p = same_point(o, l, stored[l], s.key[l], feature)) {
        p->impulse += impulse[i][l];
        for (int c = 0; c < kDim; ++c) p->friction[c] += friction[i][c][l];
        p->twist += twist[i][l];
        continue;
      }
      // What found no room is not known to later passes, which would count it again.
      if (static_cast<Real>(o.room) <= stored[l]) continue;
      const auto at = static_cast<std::int32_t>(count[l]);
      count[l] += Real(1);
      if (at >= o.room) continue;
      auto& out = o.contacts[l * o.room + at];
      out.key = s.key[l];
      out.feature = feature;
      out.normal[2] = out.point[2] = out.friction[2] = Real(0);
      for (int c = 0; c < kDim; ++c) {
        out.normal[c] = s.normal[c][l];
        out.point[c] = places[(i * kDim + c) * kLanes + l];
        out.friction[c] = friction[i][c][l];
      }
      out.separation = s.separation[i][l];
      out.impulse = impulse[i][l];
      out.twist = twist[i][l];
    }
  }
}

inline void put_touching(const Constants& t, const std::int32_t* key, int id, std::uint32_t lanes,
                         Real* touching) {
  for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
    const int l = __builtin_ctz(m);
    const kernels::PairOfKey pair = kernels::pair_of_key(t, key[l]);
    touching[t.collider_body[pair.b] * kLanes + l] = Real(1);
    if (is_fixed(static_cast<ListId>(id))) continue;
    touching[t.collider_body[pair.a] * kLanes + l] = Real(1);
  }
}

// Lanes of a block whose pair is asleep: neither body is awake.
inline std::uint32_t sleeping_lanes(const Constants& t, const Group& g, const std::int32_t* key,
                                    int id, std::uint32_t lanes) {
  std::uint32_t out = 0;
  for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
    const int l = __builtin_ctz(m);
    const kernels::PairOfKey pair = kernels::pair_of_key(t, key[l]);
    std::uint32_t asleep = g.asleep[t.collider_body[pair.b]];
    if (!is_fixed(static_cast<ListId>(id))) asleep &= g.asleep[t.collider_body[pair.a]];
    out |= asleep & (1u << l);
  }
  return out;
}

template <class S, bool kAsleep>
void observe_contacts(const Constants& t, const Group& g, kernels::Scratch* scratch,
                      const ObserverView& o) {
  Work& w = work_of(scratch);
  const std::uint32_t live = ~frozen_lanes(g) & kAllLanes;
  const bool idle = t.has_sleep && has_idle_bodies(g);
  Real* const penetration = rows_for(o, Observer::penetration);
  Real* const touching = rows_for(o, Observer::touching);
  Real* const forces = rows_for(o, Observer::link_forces);
  alignas(64) Real stored[kLanes];  // by earlier passes of this step
  Float(Real(0)).store(stored);
  if (o.contacts && t.passes > 1) Float::load(rows_for(o, Observer::contacts)).store(stored);
  for_each_observed<S>(w, [&](auto& s, int index, int id) {
    constexpr int N = std::remove_reference_t<decltype(s)>::kPoints;
    std::uint32_t lanes = s.mask & live;
    if (idle) {
      const std::uint32_t asleep = sleeping_lanes(t, g, s.key, id, lanes);
      lanes = kAsleep ? asleep : lanes & ~asleep;
    }
    if (lanes == 0) return;
    if (penetration) {
      Float deepest = Float::load(penetration);
      const Mask there = mask_from_bits(lanes);
      for (int i = 0; i < N; ++i) {
        const Mask valid = there & (Float(Real(0)) < Float::load(s.mass[i]));
        deepest = select(valid, max(deepest, -Float::load(s.separation[i])), deepest);
      }
      deepest.store(penetration);
    }
    if (!touching && !o.contacts && !forces) return;
    const auto total = totals_of<S, N, kAsleep>(t, w, s, index, id, o);
    if (touching) {
      put_touching(t, s.key, id, bits(Float(Real(0)) < total.sum) & lanes, touching);
    }
    if (forces) {
      const ContactForces<S, N> sum(t, s, total);
      sum.add_to_b(t, lanes, forces);
      if (!is_fixed(static_cast<ListId>(id))) sum.add_to_a(t, lanes, forces);
    }
    if (o.contacts) {
      put_contacts(s, total, o.places[id] + index * kPlaces<S, N> * kLanes, lanes, stored, o);
    }
  });
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
