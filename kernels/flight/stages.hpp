// Steps of bodies in free flight by the integrator of the plan. A plan in which nothing but springs
// acts between bodies is stepped here alone; in others `fly` comes before the solver, and `leave`
// takes from it the bodies that nothing could touch in the step.
#pragma once

#include "kernels/flight/schemes.hpp"
#include "kernels/motion/finish.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// The motion at the end of the step, in FlightWork::now. The state stays.
template <class S>
void fly(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  FlightWork& f = w.flight;
  copy_motion(t, f.now, g.state);
  if (t.flight.momentum) begin_spins<S>(t, g, f.now);
  for (int i = 0; i < t.substeps; ++i) step_of<S>(t.flight.scheme, t, g, w);
  if (t.flight.momentum) end_spins<S>(t, g, f.now);
}

// What springs do at the end of the step, as impulses of a substep, for observers of joints.
template <class S>
void store_forces(const Constants& t, const Group& g, std::uint32_t commit) {
  const Float h(t.h);
  for_each_spring(t, g, [&](const JointPart& part, const Joint& constants, int index) {
    const auto angular_velocity_of = [](int, const Motion<S>& m) { return m.spin; };
    const SpringNow<S> s = spring_now<S>(t, g, part, constants, g.state, angular_velocity_of);
    const auto force = elastic_force(part, constants, s) + damping_force(part, constants, s);
    Real* to = g.joint_impulse + index * kernels::kPartImpulses * kLanes;
    // Where both ends sleep the spring keeps what it will wake with.
    const Mask keep = mask_from_bits(commit & active_lanes(t, g, part));
    const auto put = [&](Float impulse, Real* row) {
      select(keep, impulse, Float::load(row)).store(row);
    };
    if (part.kind != PartKind::point) return put(dot(force, s.along) * h, to);
    put(force.x * h, to), put(force.y * h, to + kLanes);
    if constexpr (S::kDim == 3) put(force.z * h, to + 2 * kLanes);
  });
}

// The space that integrates freely for plans of another.
template <class S>
struct FlightSpace {
  using Type = Tensor;
};
template <>
struct FlightSpace<Planar> {
  using Type = Planar;
};

// Where a body is at the end of the flight, as finish asks.
template <class S>
struct FlightCommit {
  const Constants& t;
  const FlightWork& f;
  MW_INLINE auto of(int body) const {
    return load_motion<typename FlightSpace<S>::Type>(t, f.now, body);
  }
  template <class Q>
  MW_INLINE Q orientation(int body, Mask free, Q swept) const {
    return select(free, of(body).q, swept);
  }
};

template <class S, bool kIdle, class Keep>
void commit_flight(const Constants& t, const Group& g, const FlightWork& f, std::uint32_t commit,
                   Keep keep) {
  Mask inside = mask_from_bits(kAllLanes);
  for (int b = 0; b < t.bodies; ++b) {
    const auto& keep_body = keep.of(b);
    const Motion<S> m = load_motion<S>(t, f.now, b);
    const auto put = [&](const auto& fresh, int component) {
      Real* p = state_of(t, g, b, component);
      const auto kept = keep_body(fresh, p);
      store(p, kept);
      return kept;
    };
    const auto x = put(m.x, kState<S>.position);
    put(m.v, kState<S>.linear), put(m.spin, kState<S>.angular);
    if (t.has_orientation) put(m.q, kState<S>.orientation);
    if (t.has_bounds) {
      Mask in = within_bounds(t, x);
      if constexpr (kIdle) in = in | absent_lanes(g, b);
      inside = inside & in;
    }
  }
  flag_outside(g, ~bits(inside) & commit);
}

template <class S, bool kIdle>
std::uint32_t judge_flight(const Constants& t, const Group& g, const FlightWork& f) {
  LaneCheck check;
  for (int b = 0; b < t.bodies; ++b) {
    const Motion<S> m = load_motion<S>(t, f.now, b);
    const auto from = load_as<typename S::Vec>(state_of(t, g, b, kState<S>.position));
    check.add<S, kIdle>(t, g, b, {m.x - from, zero_of<typename S::Ang>()}, {m.v, m.spin});
    if (t.has_orientation) check.add_end<kIdle>(g, b, m.q, mask_from_bits(kAllLanes));
  }
  return judge_lanes(g, check);
}

template <class S>
void fly_steps(const Constants& t, const Group& g, kernels::Scratch* scratch, int steps) {
  const FlightWork& f = work_of(scratch).flight;
  std::uint32_t moved = 0;  // lanes that some step was good in
  for (int step = 0; step < steps; ++step) {
    fly<S>(t, g, scratch);
    std::uint32_t commit = 0;
    if (has_idle_bodies(g)) {
      commit = judge_flight<S, true>(t, g, f);
      commit_flight<S, true>(t, g, f, commit, LiveLanes{g, commit});
    } else {
      commit = judge_flight<S, false>(t, g, f);
      commit_flight<S, false>(t, g, f, commit, SomeLanes{mask_from_bits(commit)});
    }
    moved |= commit;
  }
  store_forces<S>(t, g, moved);
}

template <class S, bool kDense>
void leave(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const std::uint32_t commit = leave_state<S, kDense>(t, g, w, FlightCommit<S>{t, w.flight});
  store_forces<typename FlightSpace<S>::Type>(t, g, commit);
}

template <class S>
kernels::FlightTable<Real> flight_table() {
  using Space = typename FlightSpace<S>::Type;
  return {fly_steps<Space>, fly<Space>, {leave<S, true>, leave<S, false>}};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
