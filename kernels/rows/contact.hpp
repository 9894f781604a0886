// contact: the solver passes over one slot, written once for every space, point count and layout.
//
// Soft contact with substeps ("TGS soft", Catto). Normal row of a point with separation s:
//   lambda' = max(0, lambda - m (a v + bias) - i lambda)
//   s > 0: bias = s / h, a = 1, i = 0 (speculative)
//   s <= 0: bias = max(a r s, -c), soft gains a, r, i (tables.hpp, Softness), c the push-out speed
// The points of a manifold are solved in row space: their velocities are read once, each row's
// change updates the others through K's off-diagonal entries, and the sum is applied once.
// Friction: |tangent impulse| <= mu * sum(lambda), a circle; twist: |.| <= mu * sum(lambda_i
// arm_i).
#pragma once

#include "kernels/rows/velocities.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kUnlimited = Real(1e30);  // N s

enum class Pass { warm_start, bias, relax };

template <class S, int N, bool kPair, bool kDense>
using SlotVelocities = TwoVelocities<S, kPair, kDense>;

// Applies normal impulses d[i] at all points.
template <class S, int N, bool kPair, bool kDense>
MW_INLINE void apply_normal(const Slot<S, N>& s, const Float* d,
                            SlotVelocities<S, N, kPair, kDense>& v) {
  using Ang = typename S::Ang;
  using Inertia = typename S::Inertia;
  const auto n = load_as<typename S::Vec>(s.normal[0]);
  Float sum = d[0];
  Ang turn_b = load_as<Ang>(s.arm_b[0][0]) * d[0];
  for (int i = 1; i < N; ++i) {
    sum = sum + d[i];
    turn_b = fma(load_as<Ang>(s.arm_b[i][0]), d[i], turn_b);
  }
  v.b.v = fma(n, sum * Float::load(s.inv_mass_b), v.b.v);
  v.b.w = v.b.w + apply(load_as<Inertia>(s.inertia_b[0]), turn_b);
  if constexpr (kPair) {
    Ang turn_a = load_as<Ang>(s.arm_a[0][0]) * d[0];
    for (int i = 1; i < N; ++i) turn_a = fma(load_as<Ang>(s.arm_a[i][0]), d[i], turn_a);
    v.a.v = fnma(n, sum * Float::load(s.inv_mass_a), v.a.v);
    v.a.w = v.a.w - apply(load_as<Inertia>(s.inertia_a[0]), turn_a);
  }
}

// Velocity of B against A along the normal at each point.
template <class S, int N, bool kPair, bool kDense>
MW_INLINE void normal_speeds(const Slot<S, N>& s, const SlotVelocities<S, N, kPair, kDense>& v,
                             Float* speed) {
  using Ang = typename S::Ang;
  const auto n = load_as<typename S::Vec>(s.normal[0]);
  Float along = dot(n, v.b.v);
  if constexpr (kPair) along = dot(n, v.b.v - v.a.v);
  for (int i = 0; i < N; ++i) {
    speed[i] = along + dot(load_as<Ang>(s.arm_b[i][0]), v.b.w);
    if constexpr (kPair) speed[i] = speed[i] - dot(load_as<Ang>(s.arm_a[i][0]), v.a.w);
  }
}

// Adds to `gaps` how far each point has moved apart since the step began. From displacements:
// speeds seen in the middle of a pass are not those that moved the bodies.
template <class S, int N, bool kPair, bool kDense>
MW_INLINE void moved_apart(const Work& w, const Slot<S, N>& s, Float* gaps) {
  using Ang = typename S::Ang;
  const auto [a, b] = load_two<S, kPair, kDense>(w.displacement, s);
  const auto n = load_as<typename S::Vec>(s.normal[0]);
  Float along = dot(n, b.v);
  if constexpr (kPair) along = dot(n, b.v - a.v);
  for (int i = 0; i < N; ++i) {
    gaps[i] = gaps[i] + along + dot(load_as<Ang>(s.arm_b[i][0]), b.w);
    if constexpr (kPair) gaps[i] = gaps[i] - dot(load_as<Ang>(s.arm_a[i][0]), a.w);
  }
}

// Row k changed by d: the speeds of the rows after it follow.
template <class S, int N>
MW_INLINE void couple_following(const Slot<S, N>& s, int k, Float d, Float* speed) {
  int at = k * N - k * (k + 1) / 2;
  for (int j = k + 1; j < N; ++j) speed[j] = fma(Float::load(s.cross_k[at++]), d, speed[j]);
}

// Friction impulses as a world vector at the friction centre, plus a twist about the normal.
template <class S, int N, bool kPair, bool kDense>
MW_INLINE void apply_friction(const Slot<S, N>& s, const Float* d, Float twist,
                              SlotVelocities<S, N, kPair, kDense>& v) {
  using Vec = typename S::Vec;
  using Inertia = typename S::Inertia;
  Vec p = load_as<Vec>(s.tangent[0]) * d[0];
  if constexpr (S::kDim == 3) {
    const Vec n = load_as<Vec>(s.normal[0]);
    p = fma(cross(n, load_as<Vec>(s.tangent[0])), d[1], p);
  }
  auto turn_b = cross(load_as<Vec>(s.centre_b[0]), p);
  if constexpr (Slot<S, N>::kTwist) turn_b = fma(load_as<Vec>(s.normal[0]), twist, turn_b);
  v.b.v = fma(p, Float::load(s.inv_mass_b), v.b.v);
  v.b.w = v.b.w + apply(load_as<Inertia>(s.inertia_b[0]), turn_b);
  if constexpr (kPair) {
    auto turn_a = cross(load_as<Vec>(s.centre_a[0]), p);
    if constexpr (Slot<S, N>::kTwist) turn_a = fma(load_as<Vec>(s.normal[0]), twist, turn_a);
    v.a.v = fnma(p, Float::load(s.inv_mass_a), v.a.v);
    v.a.w = v.a.w - apply(load_as<Inertia>(s.inertia_a[0]), turn_a);
  }
}

// What friction may use up: accumulated impulses before, and their bounds.
struct FrictionBudget {
  Float before[2], twist_before;
  Float bound, twist_bound;
};

// Solves the friction rows; returns the accumulated impulses after. kRelaxed: what they change is
// multiplied by `relaxation`.
template <class S, int N, bool kPair, bool kDense, bool kRelaxed = false>
MW_INLINE void solve_friction(const Slot<S, N>& s, const FrictionBudget& budget,
                              SlotVelocities<S, N, kPair, kDense>& v, Float* after,
                              Float& twist_after, Float relaxation = Real(1)) {
  using Vec = typename S::Vec;
  const Vec t = load_as<Vec>(s.tangent[0]);
  Vec slip = v.b.v + cross(v.b.w, load_as<Vec>(s.centre_b[0]));
  if constexpr (kPair) {
    slip = slip - (v.a.v + cross(v.a.w, load_as<Vec>(s.centre_a[0])));
  }
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
    const Float length = sqrt(fma(p1, p1, p2 * p2));
    // Both zero only when nothing pushes; the floor keeps 0 / 0 out.
    const Float shrink = budget.bound / max(length, max(budget.bound, Real(1e-30)));
    after[0] = p1 * shrink;
    after[1] = p2 * shrink;
    d[0] = after[0] - budget.before[0];
    d[1] = after[1] - budget.before[1];
    if constexpr (Slot<S, N>::kTwist) {
      Float spin = dot(n, v.b.w);
      if constexpr (kPair) spin = dot(n, v.b.w - v.a.w);
      if constexpr (kRelaxed) spin = spin * relaxation;
      const Float p = fnma(Float::load(s.twist_mass), spin, budget.twist_before);
      twist_after = clamp(p, -budget.twist_bound, budget.twist_bound);
      twist = twist_after - budget.twist_before;
    }
  }
  apply_friction(s, d, twist, v);
}

template <class S, int N>
MW_INLINE FrictionBudget friction_budget(const Slot<S, N>& s, const Float* impulse) {
  FrictionBudget budget;
  const Float mu = Float::load(s.friction);
  Float sum = impulse[0];
  for (int i = 1; i < N; ++i) sum = sum + impulse[i];
  budget.bound = sum * mu;
  budget.before[0] = Float::load(s.tangent_impulse[0]);
  if constexpr (S::kTangents == 2) budget.before[1] = Float::load(s.tangent_impulse[1]);
  if constexpr (Slot<S, N>::kTwist) {
    Float arms = impulse[0] * Float::load(s.twist_arm[0]);
    for (int i = 1; i < N; ++i) arms = fma(impulse[i], Float::load(s.twist_arm[i]), arms);
    budget.twist_bound = arms * mu;
    budget.twist_before = Float::load(s.twist_impulse);
  }
  return budget;
}

template <class S, int N, bool kPair, bool kDense, bool kFriction, Pass kPass>
MW_INLINE void solve_slot(const Tables& t, Work& w, Slot<S, N>& s) {
  SlotVelocities<S, N, kPair, kDense> v(w, s);
  Float impulse[N], d[N];
  for (int i = 0; i < N; ++i) impulse[i] = Float::load(s.impulse[i]);

  if constexpr (kPass == Pass::warm_start) {
    apply_normal(s, impulse, v);
    if constexpr (kFriction) {
      Float f[2] = {Float::load(s.tangent_impulse[0]), Real(0)}, twist(Real(0));
      if constexpr (S::kTangents == 2) f[1] = Float::load(s.tangent_impulse[1]);
      if constexpr (Slot<S, N>::kTwist) twist = Float::load(s.twist_impulse);
      apply_friction(s, f, twist, v);
    }
  } else {
    Float speed[N];
    normal_speeds(s, v, speed);
    const Float zero(Real(0)), one(Real(1)), inv_h(t.inv_h);
    Float bias[N], scale[N], keep[N], most[N];
    if constexpr (kPass == Pass::bias) {
      const auto& soft = kPair ? t.soft_pair : t.soft_fixed;
      const Float rate(soft.bias_rate * soft.mass_scale), cap(-t.push_out_speed);
      Float gaps[N];
      for (int i = 0; i < N; ++i) gaps[i] = Float::load(s.separation[i]);
      if (w.substep > 0) {
        moved_apart<S, N, kPair, kDense>(w, s, gaps);
        for (int i = 0; i < N; ++i) gaps[i].store(s.gap[i]);
      }
      for (int i = 0; i < N; ++i) {
        const Float gap = gaps[i];
        const Mask apart = zero < gap;
        bias[i] = select(apart, gap * inv_h, max(gap * rate, cap));
        scale[i] = select(apart, one, soft.mass_scale);
        keep[i] = select(apart, zero, soft.impulse_scale);
      }
    } else {
      // The substep has moved the bodies; now remove the speed that pushing out has added. A point
      // that is still apart gets no more impulse: whether it will touch is the next substep's, or
      // the next step's, business.
      const Float h(t.h), touch(t.margin * Real(1.0 / 1024));
      for (int i = 0; i < N; ++i) {
        const Float gap = fma(h, speed[i], Float::load(s.gap[i]));
        bias[i] = max(gap, zero) * inv_h;
        most[i] = select(touch < gap, impulse[i], kUnlimited);
      }
    }
    for (int i = 0; i < N; ++i) {
      const Float mass = Float::load(s.mass[i]);
      Float x;
      if constexpr (kPass == Pass::bias) {
        x = fnma(keep[i], impulse[i], fnma(mass, fma(scale[i], speed[i], bias[i]), impulse[i]));
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
    // In the bias pass friction steadies stacks, which stand on manifolds of several points.
    if (kFriction && (kPass == Pass::relax || (N > 1 && t.friction_in_bias))) {
      Float after[2], twist_after(Real(0));
      solve_friction(s, friction_budget(s, impulse), v, after, twist_after);
      after[0].store(s.tangent_impulse[0]);
      if constexpr (S::kTangents == 2) after[1].store(s.tangent_impulse[1]);
      if constexpr (Slot<S, N>::kTwist) twist_after.store(s.twist_impulse);
    }
  }
  v.store(w, s);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
