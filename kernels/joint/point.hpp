// point: two anchors coincide. 2 rows in the plane, 3 in space, solved together:
//   C = x_B + r_B - x_A - r_A,  C' = v_B + w_B x r_B - v_A - w_A x r_A
//   K = (1/m_A + 1/m_B) E - [r_A] I_A^-1 [r_A] - [r_B] I_B^-1 [r_B]
// C, the arms r and K follow the bodies in every substep, before the relax pass: velocities that
// are solved for the arms which the substep began with gain energy from the impulses that rotate
// them (as much as explicit Euler). With a spring the anchor of B is drawn to that of A by no more
// than a given force.
#pragma once

#include "kernels/joint/held_point.hpp"
#include "kernels/rows/contact.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct PointMass {
  using Type = Sym3;
};
template <>
struct PointMass<Planar> {
  using Type = Sym2;
};
// (1 + rho) k + gamma E
MW_INLINE Sym2 soften(const Sym2& k, Float rho, Float gamma) {
  return {fma(k.xx, rho, k.xx) + gamma, fma(k.xy, rho, k.xy), fma(k.yy, rho, k.yy) + gamma};
}
MW_INLINE Sym3 soften(const Sym3& k, Float rho, Float gamma) {
  return {fma(k.xx, rho, k.xx) + gamma, fma(k.xy, rho, k.xy), fma(k.xz, rho, k.xz),
          fma(k.yy, rho, k.yy) + gamma, fma(k.yz, rho, k.yz), fma(k.zz, rho, k.zz) + gamma};
}

template <class S>
struct alignas(64) PointRows : AnchoredRows<S> {
  // Of the substep.
  Real arm_a[S::kDim][kLanes], arm_b[S::kDim][kLanes], gap[S::kDim][kLanes];
  Real mass[S::kDim * (S::kDim + 1) / 2][kLanes];  // K^-1; of a spring K' - K
  // Of a spring: K'^-1, and the gap of the bias pass.
  Real soft_mass[S::kDim * (S::kDim + 1) / 2][kLanes];
  Real drawn[S::kDim][kLanes];
  // Where the rotation is held: its free axis at the start of the step, and the answer.
  Real free_axis[S::kAng][kLanes];
  Reaction<S> reaction;
};

template <class S>
void prepare(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
             PointRows<S>& s) {
  start_anchors(anchors_of<S>(t, g, part, constants), s);
  if constexpr (S::kDim == 3) {
    if (holds_rotation(part)) store(s.free_axis[0], axis_z(frames_of<S>(t, g, part, constants).a));
  }
}

template <class S, bool kDense, bool kMoved>
MW_INLINE void refresh(const Work& w, const JointPart& part, const Joint& constants,
                       PointRows<S>& s) {
  auto now = anchors_now<S, kDense, kMoved>(w, s);
  // Targets stay apart, and trees, in which folded ropes gained energy so, use own anchors.
  if (!part.direct && !part.spring) use_common_point(s, now);
  store(s.arm_a[0], now.arm_a), store(s.arm_b[0], now.arm_b), store(s.gap[0], now.gap);
  if (kMoved && part.direct) return;
  typename PointMass<S>::Type k{};
  if (holds_rotation(part)) {
    auto axis = load_as<typename S::Ang>(s.free_axis[0]);
    if constexpr (S::kDim == 3 && kMoved) axis = axis + rotation_of<S>(w, s.body_a).change(axis);
    k = hold_point(part, s, now.arm_a, now.arm_b, axis, s.reaction);
  } else {
    add_point_mass(s.a, now.arm_a, k), add_point_mass(s.b, now.arm_b, k);
  }
  if (part.spring) {
    const Float rho = constants.soft.rho, gamma = constants.soft.gamma;
    store(s.soft_mass[0], inverse(soften(k, rho, gamma)));
    store(s.mass[0], soften(k, rho - Float(Real(1)), gamma));
  } else {
    store(s.mass[0], inverse(k));
  }
}

template <class S>
MW_INLINE typename S::Vec limit_length(typename S::Vec p, Float most) {
  const Float length = sqrt(dot(p, p));
  return p * (most / max(length, max(most, Real(1e-30))));
}

// At the anchors, with the answer of what holds the rotation.
template <class S, bool kDense, class Rows>
MW_INLINE void apply_held(const JointPart& part, const Rows& s, typename S::Vec p,
                          typename S::Vec arm_a, typename S::Vec arm_b,
                          PartVelocities<S, kDense>& v) {
  apply_at_anchors<S, kDense>(s, p, arm_a, arm_b, v);
  if (holds_rotation(part)) apply_moments<S, kDense>(s, moment_of(s.reaction, p), v);
}

// Where the bodies are already known to be.
template <class S, bool kDense, Pass kPass>
MW_INLINE void solve_placed(const Constants&, const Group&, const Work& w, const JointPart& part,
                            const Joint& constants, PointRows<S>& s, PartVelocities<S, kDense>& v) {
  using Vec = typename S::Vec;
  using Mass = typename PointMass<S>::Type;
  if constexpr (kPass == Pass::warm_start) {
    apply_held<S, kDense>(part, s, load_as<Vec>(s.impulse[0]), load_as<Vec>(s.arm_a[0]),
                          load_as<Vec>(s.arm_b[0]), v);
    return;
  }
  const auto arm_a = load_as<Vec>(s.arm_a[0]), arm_b = load_as<Vec>(s.arm_b[0]);
  const auto before = load_as<Vec>(s.impulse[0]);
  const auto mass = load_as<Mass>(s.mass[0]);
  Vec rate = anchor_speed<S, kDense>(v, arm_a, arm_b), after;
  if (part.spring) {  // its equation is the same in both passes
    if constexpr (kPass == Pass::bias) store(s.drawn[0], load_as<Vec>(s.gap[0]));
    rate = fma(load_as<Vec>(s.drawn[0]), constants.soft.bias_rate, rate) + mul(mass, before);
    after =
        limit_length<S>(before - mul(load_as<Mass>(s.soft_mass[0]), rate), constants.max_impulse);
  } else if (kPass == Pass::bias) {
    // (1 + rho)^-1 of the hard row's answer, as K' is (1 + rho) K.
    rate = rate + pull_of(load_as<Vec>(s.gap[0]), constants.soft.bias_rate, constants.pull);
    const Float rho = constants.soft.rho, firm = rho + Float(Real(1)),
                scale = Float(Real(1)) / firm;
    if (part.curved) rate = fma(curvature_between<S>(w, s, arm_a, arm_b), firm, rate);
    after = before - (mul(mass, rate) + before * rho) * scale;
  } else {
    after = before - mul(mass, rate);
  }
  store(s.impulse[0], after);
  apply_held<S, kDense>(part, s, after - before, arm_a, arm_b, v);
}
template <class S, bool kDense, Pass kPass>
MW_INLINE void solve(const Constants& t, const Group& g, const Work& w, const JointPart& part,
                     const Joint& constants, PointRows<S>& s, PartVelocities<S, kDense>& v) {
  if constexpr (kPass == Pass::relax) refresh<S, kDense, true>(w, part, constants, s);
  solve_placed<S, kDense, kPass>(t, g, w, part, constants, s, v);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
