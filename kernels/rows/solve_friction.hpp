// Friction rows of a contact in the solvers' passes: impulses along the tangents within mu times
// the normal ones, and a twist within mu times those on their arms.
#pragma once

#include "kernels/lane/solve.hpp"
#include "kernels/rows/contact_impulses.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// What friction may use up: accumulated impulses before, and their bounds.
struct FrictionBudget {
  Float before[2], twist_before;
  Float bound, twist_bound;
};

template <class S, int N>
MW_INLINE FrictionBudget friction_budget(const ContactBlock<S, N>& s, const Float* impulse) {
  FrictionBudget budget;
  const Float mu = Float::load(s.friction);
  budget.bound = sum_of<N>(impulse) * mu;
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

// In the plane: the accumulated impulse against a slip.
template <int N>
MW_INLINE Float stop_slip(const ContactBlock<Planar, N>& s, const FrictionBudget& budget,
                          Float slip) {
  const Float p = fnma(Float::load(s.tangent_mass[0]), slip, budget.before[0]);
  return clamp(p, -budget.bound, budget.bound);
}

// In space: impulses along two tangents against the slip (v1, v2), in a circle of radius `bound`.
// `stop` is the effective mass of both, `brake` a scalar one. kSeldom: few blocks slip.
template <bool kSeldom>
MW_INLINE void stop_in_circle(const Sym2& stop, Float brake, Float v1, Float v2,
                              const Float* before, Float bound, Float* after) {
  const Float p1 = fnma(stop.xy, v2, fnma(stop.xx, v1, before[0]));
  const Float p2 = fnma(stop.yy, v2, fnma(stop.xy, v1, before[1]));
  after[0] = p1, after[1] = p2;
  const Float square = fma(p1, p1, p2 * p2);
  const Mask none = max(abs(p1), abs(p2)) <= Float(Real(0));
  // Where worlds agree on what touches, nothing slips in most blocks: a root and a quotient less,
  // and the same bits.
  if (kSeldom && all(surely_within(square, bound) | none)) return;
  // What slips is braked against the slip, which the impulse that would stop it is not: bodies
  // rotate more easily about some axes than about others. The step that is cut back to the
  // bound goes along the slip itself, by one mass, so that an impulse stays as it is only when
  // it opposes the slip that it leaves; the passes of a step converge to that.
  const Float least(Real(1e-30));
  const Float c1 = fnma(brake, v1, before[0]), c2 = fnma(brake, v2, before[1]);
  // Squares of what is small would be lost, in small worlds only.
  const Float unit = Float(Real(1)) / max(max(abs(c1), abs(c2)), max(max(abs(p1), abs(p2)), least));
  const Float b = bound * unit, u1 = c1 * unit, u2 = c2 * unit;
  const Float w1 = p1 * unit, w2 = p2 * unit;
  const Float scale = b / max(sqrt(fma(u1, u1, u2 * u2)), least);
  const Mask slips = (b * b < fma(w1, w1, w2 * w2)) & !none;
  after[0] = select(slips, c1 * scale, p1);
  after[1] = select(slips, c2 * scale, p2);
}

// Solves the friction rows; returns the accumulated impulses after. kRelaxed: what they change is
// multiplied by `relaxation`.
template <bool kRelaxed = false, class S, int N, class A, class Velocities>
MW_INLINE void solve_friction(const SidedBlock<S, N, A>& s, const FrictionBudget& budget,
                              Velocities& v, Float* after, Float& twist_after,
                              Float relaxation = Real(1)) {
  auto slip = slip_of(s, v);
  if constexpr (kRelaxed) slip = slip * relaxation;
  Float d[2] = {Real(0), Real(0)}, twist(Real(0));
  if constexpr (S::kTangents == 1) {
    after[0] = stop_slip(s, budget, slip);
    d[0] = after[0] - budget.before[0];
  } else {
    const auto n = load_as<typename S::Vec>(s.normal[0]);
    const Float v1 = along_tangent(s, 0, slip), v2 = along_tangent(s, 1, slip);
    const Sym2 stop{Float::load(s.tangent_mass[0]), Float::load(s.tangent_mass[1]),
                    Float::load(s.tangent_mass[2])};
    stop_in_circle<Velocities::kIsDense>(stop, Float::load(s.slip_mass), v1, v2, budget.before,
                                         budget.bound, after);
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
MW_INLINE void store_friction(const Float* tangent, Float twist, ContactBlock<S, N>& s) {
  tangent[0].store(s.tangent_impulse[0]);
  if constexpr (S::kTangents == 2) tangent[1].store(s.tangent_impulse[1]);
  if constexpr (ContactBlock<S, N>::kTwist) twist.store(s.twist_impulse);
}

// Solves the friction rows in some lanes only.
template <class S, int N, class A, class Velocities>
MW_INLINE void solve_friction_of_lanes(SidedBlock<S, N, A>& s, Mask lanes, const Float* impulse,
                                       Velocities& v) {
  const FrictionBudget budget = friction_budget(s, impulse);
  const Velocities before = v;
  Float after[2], twist_after(Real(0));
  solve_friction(s, budget, v, after, twist_after);
  for (int c = 0; c < S::kTangents; ++c) after[c] = select(lanes, after[c], budget.before[c]);
  if constexpr (ContactBlock<S, N>::kTwist) {
    twist_after = select(lanes, twist_after, budget.twist_before);
  }
  store_friction(after, twist_after, s);
  keep_other_lanes_of_sides(lanes, before, v);
}

// Applies normal impulses d[i], then solves the friction rows.
template <class S, int N, class A, class Velocities>
MW_INLINE void apply_normal_with_friction(const SidedBlock<S, N, A>& s, const Float* d,
                                          const FrictionBudget& budget, Velocities& v, Float* after,
                                          Float& twist_after) {
  apply_normal(s, d, v);
  solve_friction(s, budget, v, after, twist_after);
}
// In the plane normal impulses make bodies that move freely slip only by rotation, so what else
// slips is known before.
template <int N, class A>
MW_INLINE void apply_normal_with_friction(const SidedBlock<Planar, N, A>& s, const Float* d,
                                          const FrictionBudget& budget,
                                          SideVelocities<Planar, A>& v, Float* after) {
  Float slip = cross(load_as<Vec2>(s.normal[0]), relative_velocity(v.a, v.b));
  apply_normal(s, d, v);
  slip = add_spin_slip(s, v, slip);
  after[0] = stop_slip(s, budget, slip);
  const Float f = after[0] - budget.before[0];
  apply_friction(s, &f, Real(0), v);
}
template <int N, class A, bool kDense>
MW_INLINE void apply_normal_with_friction(const SidedBlock<Planar, N, A>& s, const Float* d,
                                          const FrictionBudget& budget,
                                          RowVelocities<Planar, A, kDense>& v, Float* after,
                                          Float&) {
  apply_normal_with_friction(s, d, budget, static_cast<SideVelocities<Planar, A>&>(v), after);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
