// Plans without contacts: each body goes through a whole step in registers and is written back in
// place; the state before the step is kept for lanes whose new state is bad.
#pragma once

#include "kernels/motion/finish.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Velocity at the end of the substeps, the displacement by them, and the delta_v of each.
template <class S>
struct Flight {
  Velocity<S> v, moved, delta_v;
};

template <class S>
MW_INLINE Flight<S> fly(const Constants& t, const Group& g, const Work& w, int body) {
  const Float h(t.h);
  Flight<S> o;
  o.v = {load_as<typename S::Vec>(state_of(t, g, body, kState<S>.linear)),
         load_as<typename S::Ang>(state_of(t, g, body, kState<S>.angular))};
  // A delta_v of 0 makes -0 a 0; so does every step, with forces or without.
  o.v = {o.v.v + zero_of<typename S::Vec>(), o.v.w + zero_of<typename S::Ang>()};
  const typename S::Vec start = o.v.v;
  const auto& constants = constants_of_body(g, body);
  o.delta_v.v.x = constants.delta_v[0], o.delta_v.v.y = constants.delta_v[1];
  if constexpr (S::kDim == 3) o.delta_v.v.z = constants.delta_v[2];
  if (w.delta_v) o.delta_v = delta_v_of_body<S>(t, g, w, body);
  o.moved = {o.v.v - o.v.v, o.v.w - o.v.w};
  const auto substeps = [&](auto change) __attribute__((always_inline)) {
    for (int k = 0; k < t.substeps; ++k) {
      change();
      o.moved = {fma(o.v.v, h, o.moved.v), fma(o.v.w, h, o.moved.w)};
    }
  };
  if (w.delta_v || t.has_drag) {
    const Float linear = t.has_drag ? Float(constants.linear_factor) : Float(Real(1));
    const Float angular = t.has_drag ? Float(constants.angular_factor) : Float(Real(1));
    if (!w.delta_v) o.delta_v.w = o.v.w - o.v.w;
    substeps([&]() __attribute__((always_inline)) {
      o.v = {(o.v.v + o.delta_v.v) * linear, (o.v.w + o.delta_v.w) * angular};
    });
  } else if (t.has_gravity) {
    substeps([&]() __attribute__((always_inline)) { o.v.v = o.v.v + o.delta_v.v; });
  } else {
    substeps([] {});
  }
  // What symplectic substeps fall too far.
  if (t.slows) {
    o.moved.v = o.moved.v - (o.v.v - start) * Float(t.h * Real(0.5));
  } else if (t.has_gravity || w.delta_v) {
    o.moved.v = o.moved.v - o.delta_v.v * Float(t.dt * Real(0.5));
  }
  return o;
}

// Collects what became of a group in one step.
struct Outcome {
  LaneCheck check;
  Mask inside = mask_from_bits(kAllLanes);
};

template <class S, int kBodies, bool kIdle>
MW_INLINE void fly_bodies(const Constants& t, const Group& g, const Work& w, int first,
                          Outcome& outcome) {
  Flight<S> flight[kBodies];
  for (int i = 0; i < kBodies; ++i) {
    const int b = first + i;
    flight[i] = fly<S>(t, g, w, b);
    Velocity<S> moved = flight[i].moved;
    // A tensor is rotated by its own rule, which has a bound.
    if constexpr (std::is_same_v<S, Tensor>) moved.w = zero_of<typename S::Ang>();
    outcome.check.add<S, kIdle>(t, g, b, moved, flight[i].v);
    Real* p = state_of(t, g, b, kState<S>.position);
    const auto x = load_as<typename S::Vec>(p) + flight[i].moved.v;
    store(p, x);
    if (t.has_bounds) {
      Mask in = within_bounds(t, x);
      if constexpr (kIdle) in = in | absent_lanes(g, b);
      outcome.inside = outcome.inside & in;
    }
    store(state_of(t, g, b, kState<S>.linear), flight[i].v.v);
  }
  if constexpr (std::is_same_v<S, Tensor>) {
    const PrincipalInertia* tops[kBodies];
    Vec3 omega[kBodies];
    Quat q[kBodies];
    for (int i = 0; i < kBodies; ++i) {
      tops[i] = &constants_of_body(g, first + i).principal;
      omega[i] = flight[i].v.w;
      q[i] = load_quat(state_of(t, g, first + i, kState<S>.orientation));
    }
    rotate_free<kBodies>(tops, omega, q);
    for (int i = 0; i < kBodies; ++i) {
      if (t.body[first + i].kinematic) omega[i] = flight[i].v.w;
      store(state_of(t, g, first + i, kState<S>.orientation), q[i]);
      store(state_of(t, g, first + i, kState<S>.angular), omega[i]);
    }
  } else {
    for (int i = 0; i < kBodies; ++i) {
      store(state_of(t, g, first + i, kState<S>.angular), flight[i].v.w);
      if (!t.has_orientation) continue;
      rotate_body<S>(t, g, first + i, flight[i].moved.w, AllLanes{}, mask_from_bits(kAllLanes),
                     NoFlight{});
    }
  }
}

template <class S, bool kIdle>
Outcome fly_group(const Constants& t, const Group& g, Work& w) {
  // Bodies side by side hide the latency of the tumbling; the others have none to hide.
  constexpr int kTogether = std::is_same_v<S, Tensor> ? 4 : 1;
  if (w.delta_v) rotate_body_rows(t, g, w, false);
  Outcome outcome;
  int b = 0;
  for (; b + kTogether <= t.bodies; b += kTogether)
    fly_bodies<S, kTogether, kIdle>(t, g, w, b, outcome);
  for (; b < t.bodies; ++b) fly_bodies<S, 1, kIdle>(t, g, w, b, outcome);
  return outcome;
}

MW_INLINE void copy_state(Real* to, const Real* from, int size) {
  for (int i = 0; i < size; i += kLanes) Float::load(from + i).store(to + i);
}

// The steps of one call. As long as every lane is good, one copy of the state at their start is
// enough; a group with a bad lane goes through them again with a copy for each. Disabled bodies get
// their state back in every step, too.
template <class S>
void free_motion_steps(const Constants& t, const Group& g, Work& w, int steps) {
  const int size = t.bodies * t.state_stride * kLanes;
  w.delta_v = g.force || t.attractors > 0 ? w.delta_v_storage : nullptr;
  copy_state(w.before, g.state, size);
  std::uint32_t outside = 0;
  const bool idle = has_idle_bodies(g);
  bool good = frozen_lanes(g) == 0 && !idle;
  for (int step = 0; good && step < steps; ++step) {
    const Outcome outcome = fly_group<S, false>(t, g, w);
    good = all(outcome.check.good);
    outside |= ~bits(outcome.inside);
  }
  if (good) {
    flag_outside(g, outside & kAllLanes);
    return;
  }
  copy_state(g.state, w.before, size);
  for (int step = 0; step < steps; ++step) {
    copy_state(w.before, g.state, size);
    const Outcome outcome = idle ? fly_group<S, true>(t, g, w) : fly_group<S, false>(t, g, w);
    const std::uint32_t commit = judge_lanes(g, outcome.check);
    const int block = t.state_stride * kLanes;
    for (int b = 0; b < t.bodies; ++b) {
      const Mask keep = mask_from_bits(commit & ~(idle ? idle_lanes(g, b) : 0));
      for (int i = b * block; i < (b + 1) * block; i += kLanes) {
        select(keep, Float::load(g.state + i), Float::load(w.before + i)).store(g.state + i);
      }
    }
    flag_outside(g, ~bits(outcome.inside) & commit);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
