// sweep: the passes over contacts of the solvers that work by several sweeps before the bodies
// move (projected Gauss-Seidel, SOR, nonsmooth conjugate gradients, penalty). Normal row of a
// point with gap s, before relaxation r:
//   lambda' = max(0, lambda - r (m (a v + bias) + i lambda))
//   s > 0: bias = s / h, a = 1, i = 0 (speculative)
//   s <= 0: bias = max(a b min(s + slop, 0), -c), gains a, b, i (tables.hpp, Softness), c the
//           push-out speed
// Hard rows have a = 1, i = 0 and b = share / h (Baumgarte 1972), or b = 0 where `part` removes
// overlaps by displacements; soft ones have no slop.
#pragma once

#include "kernels/solver/restitution.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <bool kDense, class S, int N, class A>
MW_INLINE void sweep_block(const Constants& t, Work& w, SidedBlock<S, N, A>& s) {
  RowVelocities<S, A, kDense> v(w, s);
  const Float zero(Real(0)), one(Real(1)), inv_h(t.inv_h), relaxation(t.solver.relaxation);
  const Float slop(t.solver.slop);
  const auto& soft = A::kMoves ? t.soft_pair : t.soft_fixed;
  const Float rate(soft.bias_rate * soft.mass_scale), cap(-t.push_out_speed);
  Float impulse[N], d[N], gap[N], speed[N];
  for (int i = 0; i < N; ++i) {
    impulse[i] = Float::load(s.impulse[i]);
    gap[i] = Float::load(s.gap[i]);
  }
  if (w.sweep == 0 && w.substep > 0) {
    for (int i = 0; i < N; ++i) gap[i] = Float::load(s.separation[i]);
    moved_apart<kDense>(w, s, gap);
    for (int i = 0; i < N; ++i) gap[i].store(s.gap[i]);
  }
  normal_speeds(s, v, speed);
  for (int i = 0; i < N; ++i) {
    const Mask apart = zero < gap[i];
    const Float bias = select(apart, gap[i] * inv_h, max(min(gap[i] + slop, zero) * rate, cap));
    const Float scale = select(apart, one, soft.mass_scale);
    const Float keep = select(apart, zero, soft.impulse_scale);
    const Float change = fma(keep, impulse[i], Float::load(s.mass[i]) * fma(scale, speed[i], bias));
    const Float total = max(fnma(relaxation, change, impulse[i]), zero);
    d[i] = total - impulse[i];
    impulse[i] = total;
    total.store(s.impulse[i]);
    couple_following(s, i, d[i], speed);
  }
  apply_normal(s, d, v);
  if (t.has_friction) {
    Float after[2], twist_after(Real(0));
    solve_friction<true>(s, friction_budget(s, impulse), v, after, twist_after, relaxation);
    store_friction(after, twist_after, s);
  }
  v.store(w, s);
}

// Moves the bodies of a block apart by what is left of their share of the overlap that the substep
// began with; w.velocity holds displacements.
template <bool kDense, class S, int N, class A>
MW_INLINE void separate_block(const Constants& t, Work& w, const SidedBlock<S, N, A>& s) {
  RowVelocities<S, A, kDense> moved(w, s);
  const Float zero(Real(0)), share(t.solver.push_out_share), most(t.push_out_speed * t.h);
  const Float slop(t.solver.slop);
  Float way[N], d[N];
  normal_speeds(s, moved, way);
  for (int i = 0; i < N; ++i) {
    const Float began = Float::load(s.gap[i]);
    const Float wanted = began + min(max((began + slop) * -share, zero), most);
    const Float gap = Float::load(s.separation[i]) + way[i];
    const Mask overlaps = began < zero;
    d[i] = select(overlaps, Float::load(s.mass[i]) * max(wanted - gap, zero), zero);
    couple_following(s, i, d[i], way);
  }
  apply_normal(s, d, moved);
  moved.store(w, s);
}

template <class S, bool kDense>
struct Sweeps {
  static void sweep(const Constants& t, const Group&, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    for_each_block<S>(w, [&](auto& s, int, BlockList&) { sweep_block<kDense>(t, w, s); });
    ++w.sweep;
  }

  static void part(const Constants& t, const Group&, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    Real* const velocity = w.velocity;
    w.velocity = w.displacement;
    for_each_block<S>(w, [&](auto& s, int, BlockList&) { separate_block<kDense>(t, w, s); });
    w.velocity = velocity;
  }

  // What the contacts of the substep have done, for restitution.
  static void tally(const Constants& t, const Group&, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    for_each_block<S>(w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      accumulate_bounce(s, bounce_at<S, N>(list, i), t.has_friction);
    });
  }

  static kernels::SweepTable<Real> table() { return {sweep, part, tally}; }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
