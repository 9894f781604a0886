// Accelerations of a group's bodies at some motion of theirs: gravity, wind and drag, attractors,
// inputs, controls and springs.
#pragma once

#include "kernels/flight/motion.hpp"
#include "kernels/joint/breaking.hpp"
#include "kernels/joint/coordinates.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A spring between anchors of two bodies: its force on B, which A gets with the other sign.
//   between points (TargetJoint)    f = -k gap - c gap'
//   along a line (DistanceJoint)    f = -(k (|gap| - rest) + c |gap|') n
template <class S>
struct SpringNow {
  using Vec = typename S::Vec;
  Vec arm_a, arm_b, gap, speed;
  Vec along;     // n
  Float length;  // of the gap, m; of a spring between points 0
  Mask active;   // lanes in which it holds
};

// `angular_velocity_of(body, motion)`: of that body, rad/s.
template <class S, class AngularVelocity>
SpringNow<S> spring_now(const Constants& t, const Group& g, const JointPart& part,
                        const Joint& constants, const Real* motion,
                        AngularVelocity angular_velocity_of) {
  using Vec = typename S::Vec;
  SpringNow<S> s;
  const Motion<S> b = load_motion<S>(t, motion, part.body_b);
  const Vec anchor_a = vector_of(S{}, constants.anchor_a);
  s.arm_b = rotate(b.q, vector_of(S{}, constants.anchor_b));
  s.speed = b.v + cross(angular_velocity_of(part.body_b, b), s.arm_b);
  if (part.body_a == t.bodies) {
    s.arm_a = zero_of<Vec>();
    s.gap = (b.x - anchor_a) + s.arm_b;
  } else {
    const Motion<S> a = load_motion<S>(t, motion, part.body_a);
    s.arm_a = rotate(a.q, anchor_a);
    s.gap = (b.x - a.x) + (s.arm_b - s.arm_a);
    s.speed = s.speed - (a.v + cross(angular_velocity_of(part.body_a, a), s.arm_a));
  }
  s.along = direction_of(s.gap, s.length);
  s.active = mask_from_bits(active_lanes(t, g, part));
  return s;
}

template <class S>
MW_INLINE SpringNow<S> spring_now(const Constants& t, const Group& g, const JointPart& part,
                                  const Joint& constants, const Real* motion) {
  return spring_now<S>(t, g, part, constants, motion, [&](int body, const Motion<S>& m) {
    return angular_velocity(t, g, body, m);
  });
}

template <class S>
MW_INLINE typename S::Vec elastic_force(const JointPart& part, const Joint& constants,
                                        const SpringNow<S>& s) {
  const Float k = constants.stiffness;
  if (part.kind == PartKind::point) return s.gap * -k;
  return s.along * (k * (Float(constants.target_position) - s.length));
}
template <class S>
MW_INLINE typename S::Vec damping_force(const JointPart& part, const Joint& constants,
                                        const SpringNow<S>& s) {
  const Float c = constants.damping;
  if (part.kind == PartKind::point) return s.speed * -c;
  return s.along * -(c * dot(s.along, s.speed));
}

// Calls visit(part, numbers, index) for every spring.
template <class Visit>
MW_INLINE void for_each_spring(const Constants& t, const Group& g, Visit visit) {
  if (t.flight.springs == 0) return;
  for (int i = 0; i < t.parts; ++i) {
    if (t.part[i].force) visit(t.part[i], constants_of_part(g, i), i);
  }
}

// Adds a force at an arm to what a body has in `rate`: accelerations, and torques.
template <class S>
MW_INLINE void add_force(const Constants& t, const Group& g, Real* rate, int body,
                         typename S::Vec force, typename S::Vec arm) {
  if (body == t.bodies || t.body[body].kinematic) return;
  Real* linear = component_of(t, rate, body, kState<S>.linear);
  Real* angular = component_of(t, rate, body, kState<S>.angular);
  store(linear, fma(force, constants_of_body(g, body).inv_mass, load_as<typename S::Vec>(linear)));
  store(angular, load_as<typename S::Ang>(angular) + cross(arm, force));
}

// Into the rows of linear and angular rates: accelerations by all forces but drag, and torques.
// kDamped: springs damp, too.
template <class S, bool kDamped>
void gather_forces(const Constants& t, const Group& g, const Real* motion, Real* rate) {
  for (int b = 0; b < t.bodies; ++b) {
    const Motion<S> m = load_motion<S>(t, motion, b);
    const Body& constants = constants_of_body(g, b);
    // Adding 0 makes -0 a 0, as the inputs of another world would.
    auto a = vector_of(S{}, constants.acceleration) + zero_of<typename S::Vec>();
    auto torque = zero_of<typename S::Ang>();
    if (!t.body[b].kinematic) {
      for (int i = 0; i < t.attractors; ++i) {
        a = a + Attraction<S>(g, b, i, m.x).acceleration();
      }
      if (g.force || is_thrust(t, b)) {
        const Load<S> load =
            load_of_body<S>(t, g, b, component_of(t, motion, b, kState<S>.orientation));
        a = fma(load.force, constants.inv_mass, a);
        torque = load.torque;
      }
    }
    store(component_of(t, rate, b, kState<S>.linear), a);
    store(component_of(t, rate, b, kState<S>.angular), torque);
  }
  for_each_spring(t, g, [&](const JointPart& part, const Joint& constants, int) {
    const SpringNow<S> s = spring_now<S>(t, g, part, constants, motion);
    auto force = elastic_force(part, constants, s);
    if constexpr (kDamped) force = force + damping_force(part, constants, s);
    force = select(s.active, force, zero_of<typename S::Vec>());
    add_force<S>(t, g, rate, part.body_b, force, s.arm_b);
    add_force<S>(t, g, rate, part.body_a, -force, s.arm_a);
  });
}

// Rates of velocities and spins at a motion. kTumbling: with the gyroscopic rate of angular
// velocities where no torque acts; without it, what a torque does to a body that stands still.
template <class S, bool kTumbling>
void accelerate(const Constants& t, const Group& g, const Real* motion, Real* rate) {
  gather_forces<S, true>(t, g, motion, rate);
  for (int b = 0; b < t.bodies; ++b) {
    const Motion<S> m = load_motion<S>(t, motion, b);
    const Body& constants = constants_of_body(g, b);
    Real* linear = component_of(t, rate, b, kState<S>.linear);
    Real* angular = component_of(t, rate, b, kState<S>.angular);
    auto torque = load_as<typename S::Ang>(angular);
    if (!spins_by_momentum(t, b)) {
      if constexpr (kTumbling && S::kDim == 3) {
        torque = torque - cross(m.spin, weigh(constants.inertia, m.q, m.spin));
      }
      torque = weigh(constants.inv_inertia, m.q, torque);
    }
    if (t.has_drag) {
      store(linear, fnma(m.v, constants.linear_drag, load_as<typename S::Vec>(linear)));
      torque = fnma(m.spin, constants.angular_drag, torque);
    }
    store(angular, torque);
  }
}

// Rates of everything. `share` of the last rates, if they were not the first of the step, led from
// its start to this motion.
template <class S>
void find_rates(const Constants& t, const Group& g, const Real* motion, Real* rate, Float share,
                bool first) {
  accelerate<S, true>(t, g, motion, rate);
  for (int b = 0; b < t.bodies; ++b) {
    const Motion<S> m = load_motion<S>(t, motion, b);
    store(component_of(t, rate, b, kState<S>.position), m.v);
    if (!t.has_orientation) continue;
    store_rotation_rate(t, component_of(t, rate, b, kState<S>.orientation),
                        angular_velocity(t, g, b, m), m, share, first);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
