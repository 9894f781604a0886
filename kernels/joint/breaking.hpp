// Joints that break: what each bears in a step is added up over the substeps; those that bore more
// than they can hold nothing from the next step on, in the lanes in which they did.
#pragma once

#include "kernels/joint/coordinates.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Reals of what a joint bears: impulse and angular impulse.
template <class S>
inline constexpr int kLoadRows = (S::kDim + S::kAng) * kLanes;

// What a part gave B in a substep.
template <class S>
struct Impulse {
  typename S::Vec linear;
  typename S::Ang angular;
};
template <class S>
MW_INLINE Float along_row(const PartBodies<S>& s) {
  return Float::load(s.impulse[0]) + (Float::load(s.impulse[1]) - Float::load(s.impulse[2]));
}
template <class S>
MW_INLINE Impulse<S> impulse_of(const Row<S>& s) {
  const Float along = along_row(s);
  return {load_as<typename S::Vec>(s.linear_b[0]) * along,
          load_as<typename S::Ang>(s.moment[0]) * along};
}
// Points and lines keep a linear impulse, locks and swings an angular one.
template <class S>
MW_INLINE Impulse<S> impulse_of(const AnchoredRows<S>& s) {
  return {load_as<typename S::Vec>(s.impulse[0]), zero_of<typename S::Ang>()};
}
template <class S>
MW_INLINE Impulse<S> impulse_of(const PartBodies<S>& s) {
  return {zero_of<typename S::Vec>(), load_as<typename S::Ang>(s.impulse[0])};
}

// Lanes in which a part acts: it holds, its bodies are there, and one of them is awake.
MW_INLINE std::uint32_t active_lanes(const Constants& t, const Group& g, const JointPart& part) {
  const std::uint32_t holds = kAllLanes & ~(g.disabled_joints ? g.disabled_joints[part.joint] : 0u);
  if (!has_idle_bodies(g)) return holds;
  if (part.body_a == t.bodies) return holds & ~idle_lanes(g, part.body_b);
  return holds & live_lanes(g, part.body_a, part.body_b);
}

MW_INLINE Float length_of(Float x) { return abs(x); }
template <class V>
MW_INLINE Float length_of(V v) {
  return sqrt(dot(v, v));
}

// Joints without a broken one between them that hang together pass on what the broken one bore:
// those of a lane forget their impulses, which would throw up what hung on it.
MW_INLINE void forget_load(const Constants& t, const Group& g, Work& w, int body_a, int body_b,
                           int lane) {
  const auto passes_on = [&](int body) { return body < t.bodies && !t.body[body].kinematic; };
  for (int b = 0; b < t.bodies; ++b) w.reached[b] = 0;
  if (passes_on(body_a)) w.reached[body_a] = 1;
  if (passes_on(body_b)) w.reached[body_b] = 1;
  const auto holds = [&](const JointPart& part) {
    return !((g.disabled_joints[part.joint] >> lane) & 1u);
  };
  const auto reached = [&](int body) { return passes_on(body) && w.reached[body] != 0; };
  for (bool grows = true; grows;) {
    grows = false;
    for (int i = 0; i < t.parts; ++i) {
      const JointPart& part = t.part[i];
      const int a = part.body_a, b = part.body_b;
      if (!holds(part) || reached(a) == reached(b)) continue;
      const int next = reached(a) ? b : a;
      if (!passes_on(next)) continue;
      w.reached[next] = 1;
      grows = true;
    }
  }
  for (int i = 0; i < t.parts; ++i) {
    const JointPart& part = t.part[i];
    if (holds(part) && !reached(part.body_a) && !reached(part.body_b)) continue;
    Real* p = g.joint_impulse + i * kernels::kPartImpulses * kLanes + lane;
    for (int k = 0; k < kernels::kPartImpulses; ++k) p[k * kLanes] = Real(0);
  }
}

template <class S>
void break_joints(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  const std::uint32_t frozen = frozen_lanes(g);  // also those that this step froze
  for (int i = 0; i < t.breakable; ++i) {
    const kernels::BreakTable& joint = t.breaking[i];
    const auto* from = w.loads + i * kLoadRows<S>;
    const auto force = load_as<typename S::Vec>(from);
    const auto torque = load_as<typename S::Ang>(from + S::kDim * kLanes);
    const JointPart& part = t.part[joint.first_part];
    const Joint& most = constants_of_part(g, joint.first_part);
    const std::uint32_t lanes = bits((Float(most.max_force) < length_of(force)) |
                                     (Float(most.max_torque) < length_of(torque))) &
                                active_lanes(t, g, part) & ~frozen;
    if (lanes == 0) continue;
    g.disabled_joints[joint.joint] |= lanes;
    // What hung on it is not held, however slow it is (kernels/sleep/sleep.cpp).
    w.touched[part.body_a] &= ~lanes;
    w.touched[part.body_b] &= ~lanes;
    for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
      const int l = __builtin_ctz(m);
      g.status[l] |= kernels::kJointBroken;
      forget_load(t, g, w, part.body_a, part.body_b, l);
    }
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
