// contact: the solver passes over one block, written once for every space, point count and layout.
//
// Soft contact with substeps ("TGS soft", Catto). Normal row of a point with separation s:
//   lambda' = max(0, rigid - m bias - lost), rigid = lambda - m v, lost = i rigid
//   s > 0: bias = s / h, i = 0 (speculative)
//   s <= 0: bias = a r s, soft gains a, r, i with a = 1 - i (tables.hpp, Softness), but
//           m bias >= -max(m c, i lambda + m c / 8)
// with the push-out speed c, against fixed shapes up to twice as much where what they overlap is
// half of the length unit or deeper. What a load takes comes on top, so that no load is too much.
// A spring sags under what presses on it by F / (m w^2), however small the bodies. Against fixed
// shapes `lost` is no more than m times the speed fixed_leak under a load of gravity and forces,
// which sags by a hundredth of the length unit. Impacts lose as before: stiffer rows would throw
// light bodies from under heavy ones. The points of a manifold are solved in row space: their
// velocities are read once, each row's change updates the others through K's off-diagonal entries,
// and the sum is applied once. Friction: |tangent impulse| <= mu * sum(lambda), a circle; twist:
// |.| <= mu * sum(lambda_i arm_i).
#pragma once

#include "kernels/rows/blow.hpp"
#include "kernels/rows/touched.hpp"
#include "kernels/rows/velocities.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kUnlimited = Real(1e30);       // N s
inline constexpr Real kPushUnderLoad = Real(0.125);  // of c

enum class Pass { warm_start, bias, relax };

// The moment of impulses d[i] along the normal at all points, about the centre of mass.
template <class S, int N>
MW_INLINE typename S::Ang normal_moment(const ContactSide<S, N, Free>& side, const Float* d) {
  using Ang = typename S::Ang;
  Ang moment = load_as<Ang>(side.arm[0][0]) * d[0];
  for (int i = 1; i < N; ++i) moment = fma(load_as<Ang>(side.arm[i][0]), d[i], moment);
  return moment;
}

// Applies normal impulses d[i] at all points.
template <class S, int N, class A, class Velocities>
MW_INLINE void apply_normal(const SidedBlock<S, N, A>& s, const Float* d, Velocities& v) {
  const auto n = load_as<typename S::Vec>(s.normal[0]);
  Float sum = d[0];
  for (int i = 1; i < N; ++i) sum = sum + d[i];
  add_impulse(s.b, n, sum, normal_moment(s.b, d), v.b);
  if constexpr (A::kMoves) take_impulse(s.a, n, sum, normal_moment(s.a, d), v.a);
}

// The speed of B against A along the normal at point i; x: what it is on top of, along the normal.
template <class S, int N, class A, class Velocities>
MW_INLINE Float normal_speed(const SidedBlock<S, N, A>& s, int i, const Velocities& v, Float x) {
  using Ang = typename S::Ang;
  x = x + dot(load_as<Ang>(s.b.arm[i][0]), v.b.w);
  if constexpr (A::kMoves) x = x - dot(load_as<Ang>(s.a.arm[i][0]), v.a.w);
  return x;
}
template <class S, int N, class A, class Velocities>
MW_INLINE void normal_speeds(const SidedBlock<S, N, A>& s, const Velocities& v, Float* speed) {
  const Float along = dot(load_as<typename S::Vec>(s.normal[0]), relative_velocity(v.a, v.b));
  for (int i = 0; i < N; ++i) speed[i] = normal_speed(s, i, v, along);
}

// Adds to `gaps` how far each point has moved apart since the step began. From displacements:
// speeds seen in the middle of a pass are not those that moved the bodies.
template <bool kDense, class S, int N, class A>
MW_INLINE void moved_apart(const Work& w, const SidedBlock<S, N, A>& s, Float* gaps) {
  const auto moved = load_sides<S, A, kDense>(w.displacement, s);
  const Float along =
      dot(load_as<typename S::Vec>(s.normal[0]), relative_velocity(moved.a, moved.b));
  for (int i = 0; i < N; ++i) gaps[i] = normal_speed(s, i, moved, gaps[i] + along);
}

// The moment of an impulse p at the friction centre, and a twist about the normal.
template <class S, int N>
MW_INLINE typename S::Ang friction_moment(const ContactSide<S, N, Free>& side, typename S::Vec p,
                                          typename S::Vec normal, Float twist) {
  auto moment = cross(load_as<typename S::Vec>(side.centre[0]), p);
  if constexpr (ContactBlock<S, N>::kTwist) moment = fma(normal, twist, moment);
  return moment;
}

// Applies friction impulses along the tangents, and a twist about the normal.
template <class S, int N, class A, class Velocities>
MW_INLINE void apply_friction(const SidedBlock<S, N, A>& s, const Float* d, Float twist,
                              Velocities& v) {
  using Vec = typename S::Vec;
  const Vec n = load_as<Vec>(s.normal[0]);
  Vec p = load_as<Vec>(s.tangent[0]) * d[0];
  if constexpr (S::kDim == 3) p = fma(cross(n, load_as<Vec>(s.tangent[0])), d[1], p);
  add_impulse(s.b, p, friction_moment(s.b, p, n, twist), v.b);
  if constexpr (A::kMoves) take_impulse(s.a, p, friction_moment(s.a, p, n, twist), v.a);
}

// The velocity of B against A at the friction centre.
template <class S, int N, class A, class Velocities>
MW_INLINE typename S::Vec slip_of(const SidedBlock<S, N, A>& s, const Velocities& v) {
  using Vec = typename S::Vec;
  Vec slip = point_velocity(v.b, load_as<Vec>(s.b.centre[0]));
  if constexpr (A::kMoves) slip = slip - point_velocity(v.a, load_as<Vec>(s.a.centre[0]));
  return slip;
}

// What friction may use up: accumulated impulses before, and their bounds.
struct FrictionBudget {
  Float before[2], twist_before;
  Float bound, twist_bound;
};

// Solves the friction rows; returns the accumulated impulses after. kRelaxed: what they change is
// multiplied by `relaxation`.
template <bool kRelaxed = false, class S, int N, class A, class Velocities>
MW_INLINE void solve_friction(const SidedBlock<S, N, A>& s, const FrictionBudget& budget,
                              Velocities& v, Float* after, Float& twist_after,
                              Float relaxation = Real(1)) {
  using Vec = typename S::Vec;
  const Vec t = load_as<Vec>(s.tangent[0]);
  Vec slip = slip_of(s, v);
  if constexpr (kRelaxed) slip = slip * relaxation;
  Float d[2] = {Real(0), Real(0)}, twist(Real(0));
  if constexpr (S::kTangents == 1) {
    const Float p = fnma(Float::load(s.tangent_mass[0]), dot(t, slip), budget.before[0]);
    after[0] = clamp(p, -budget.bound, budget.bound);
    d[0] = after[0] - budget.before[0];
  } else {
    const Vec n = load_as<Vec>(s.normal[0]);
    const Float v1 = dot(t, slip), v2 = dot(cross(n, t), slip);
    const Float m11 = Float::load(s.tangent_mass[0]), m12 = Float::load(s.tangent_mass[1]),
                m22 = Float::load(s.tangent_mass[2]);
    const Float p1 = fnma(m12, v2, fnma(m11, v1, budget.before[0]));
    const Float p2 = fnma(m22, v2, fnma(m12, v1, budget.before[1]));
    after[0] = p1, after[1] = p2;
    const Float square = fma(p1, p1, p2 * p2);
    const Mask none = max(abs(p1), abs(p2)) <= Float(Real(0));
    // Where worlds agree on what touches, nothing slips in most blocks: a root and a quotient less,
    // and the same bits.
    if (!Velocities::kIsDense || !all(surely_within(square, budget.bound) | none)) {
      // Both zero only without any impulse; the floor keeps 0 / 0 out.
      const Float shrink = budget.bound / max(sqrt(square), max(budget.bound, Real(1e-30)));
      after[0] = p1 * shrink;
      after[1] = p2 * shrink;
    }
    d[0] = after[0] - budget.before[0];
    d[1] = after[1] - budget.before[1];
    if constexpr (ContactBlock<S, N>::kTwist) {
      Float spin = dot(n, relative_spin(v.a, v.b));
      if constexpr (kRelaxed) spin = spin * relaxation;
      const Float p = fnma(Float::load(s.twist_mass), spin, budget.twist_before);
      twist_after = clamp(p, -budget.twist_bound, budget.twist_bound);
      twist = twist_after - budget.twist_before;
    }
  }
  apply_friction(s, d, twist, v);
}

template <class S, int N>
MW_INLINE FrictionBudget friction_budget(const ContactBlock<S, N>& s, const Float* impulse) {
  FrictionBudget budget;
  const Float mu = Float::load(s.friction);
  Float sum = impulse[0];
  for (int i = 1; i < N; ++i) sum = sum + impulse[i];
  budget.bound = sum * mu;
  budget.before[0] = Float::load(s.tangent_impulse[0]);
  if constexpr (S::kTangents == 2) budget.before[1] = Float::load(s.tangent_impulse[1]);
  if constexpr (ContactBlock<S, N>::kTwist) {
    Float arms = impulse[0] * Float::load(s.twist_arm[0]);
    for (int i = 1; i < N; ++i) arms = fma(impulse[i], Float::load(s.twist_arm[i]), arms);
    budget.twist_bound = arms * mu;
    budget.twist_before = Float::load(s.twist_impulse);
  }
  return budget;
}

// `v`: the velocities of its sides, as they are loaded and as impulses change them.
template <bool kDense, bool kFriction, Pass kPass, class S, int N, class A, class Velocities>
MW_INLINE void solve_rows(const Constants& t, Work& w, SidedBlock<S, N, A>& s, Velocities& v) {
  Float impulse[N], d[N];
  for (int i = 0; i < N; ++i) impulse[i] = Float::load(s.impulse[i]);

  if constexpr (kPass == Pass::warm_start) {
    apply_normal(s, impulse, v);
    if constexpr (kFriction) {
      Float f[2] = {Float::load(s.tangent_impulse[0]), Real(0)}, twist(Real(0));
      if constexpr (S::kTangents == 2) f[1] = Float::load(s.tangent_impulse[1]);
      if constexpr (ContactBlock<S, N>::kTwist) twist = Float::load(s.twist_impulse);
      apply_friction(s, f, twist, v);
    }
  } else {
    Float speed[N];
    normal_speeds(s, v, speed);
    const Float zero(Real(0)), inv_h(t.inv_h);
    // m/s; of rigid impulses what is given up; m/s of the push-out; N s, of relaxing rows at most.
    Float bias[N], keep[N], push_out[N], most[N];
    if constexpr (kPass == Pass::bias) {
      const auto& soft = A::kMoves ? t.soft_pair : t.soft_fixed;
      const Float rate(soft.bias_rate * soft.mass_scale), push(t.push_out_speed);
      Float gaps[N];
      for (int i = 0; i < N; ++i) gaps[i] = Float::load(s.separation[i]);
      if (w.substep > 0) {
        moved_apart<kDense>(w, s, gaps);
        for (int i = 0; i < N; ++i) gaps[i].store(s.gap[i]);
      }
      for (int i = 0; i < N; ++i) {
        const Float gap = gaps[i];
        const Mask apart = zero < gap;
        bias[i] = gap * select(apart, inv_h, rate);
        keep[i] = select(apart, zero, soft.impulse_scale);
        push_out[i] = A::kMoves ? push : clamp(gap * Float(-t.push_out_rate), push, push + push);
      }
    } else {
      // The substep has moved the bodies; now remove the speed that the push-out has added. A point
      // that is still apart gets no more impulse: whether it will touch is the next substep's, or
      // the next step's, business.
      const Float h(t.h), touch(t.margin * Real(1.0 / 1024));
      for (int i = 0; i < N; ++i) {
        const Float gap = fma(h, speed[i], Float::load(s.gap[i]));
        bias[i] = max(gap, zero) * inv_h;
        most[i] = select(touch < gap, impulse[i], kUnlimited);
      }
    }
    if (kPass == Pass::bias && N > 1 && w.substep == 0) {  // what comes suddenly comes with a step
      Float least = zero;
      for (int i = 0; i < N; ++i) least = min(least, speed[i] + max(bias[i], zero));
      const Float pressed = Float::load(s.press);  // faster ones are impacts
      const Mask blow = (least < Float(-t.blow_speed)) & (-(pressed + pressed) < least);
      if (any(blow)) {
        const Blow<N> found = settle_blow(s, blow, bias, speed, impulse);
        for (int i = 0; i < N; ++i) {
          impulse[i] = impulse[i] + found.impulse[i], speed[i] = speed[i] + found.speed[i];
        }
        apply_normal(s, found.impulse, v);
      }
    }
    for (int i = 0; i < N; ++i) {
      const Float mass = Float::load(s.mass[i]);
      Float x;
      if constexpr (kPass == Pass::bias) {
        const Float rigid = fnma(mass, speed[i], impulse[i]), cap = mass * push_out[i];
        const Float under_load = fma(cap, kPushUnderLoad, keep[i] * impulse[i]);
        const Float push = min(mass * -bias[i], max(cap, under_load));
        if constexpr (A::kMoves) {
          x = fnma(keep[i], rigid, rigid + push);
        } else {
          const Float lost = keep[i] * rigid, pressed = mass * Float::load(s.press);
          const Float struck = fnma(keep[i], pressed + pressed, lost);
          x = rigid + (push - min(lost, max(mass * Float(t.fixed_leak), struck)));
        }
      } else {
        x = fnma(mass, speed[i] + bias[i], impulse[i]);
      }
      Float total = max(x, zero);
      if constexpr (kPass == Pass::relax) total = min(total, most[i]);
      d[i] = total - impulse[i];
      impulse[i] = total;
      total.store(s.impulse[i]);
      couple_following(s, i, d[i], speed);
    }
    apply_normal(s, d, v);
    if constexpr (kPass == Pass::bias) mark_reached<S, A, kDense>(w, s);
    // In the bias pass friction steadies stacks, which stand on manifolds of several points.
    if (kFriction && (kPass == Pass::relax || (N > 1 && t.friction_in_bias))) {
      Float after[2], twist_after(Real(0));
      solve_friction(s, friction_budget(s, impulse), v, after, twist_after);
      after[0].store(s.tangent_impulse[0]);
      if constexpr (S::kTangents == 2) after[1].store(s.tangent_impulse[1]);
      if constexpr (ContactBlock<S, N>::kTwist) twist_after.store(s.twist_impulse);
    }
  }
}

template <bool kDense, bool kFriction, Pass kPass, class S, int N, class A>
MW_INLINE void solve_block(const Constants& t, Work& w, SidedBlock<S, N, A>& s) {
  RowVelocities<S, A, kDense> v(w, s);
  solve_rows<kDense, kFriction, kPass>(t, w, s, v);
  v.store(w, s);
}

// Two that are apart (apart.hpp): the velocities of the second are on their way while the first is
// solved, which is a long chain of operations that wait for each other.
template <bool kDense, bool kFriction, Pass kPass, class S, int N, class A>
MW_INLINE void solve_two_blocks(const Constants& t, Work& w, SidedBlock<S, N, A>& first,
                                SidedBlock<S, N, A>& second) {
  RowVelocities<S, A, kDense> of_first(w, first), of_second(w, second);
  solve_rows<kDense, kFriction, kPass>(t, w, first, of_first);
  solve_rows<kDense, kFriction, kPass>(t, w, second, of_second);
  of_first.store(w, first);
  of_second.store(w, second);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
