// The passes over the rows of resistance (rows/resistance.hpp), in the order of the blocks.
#pragma once

#include "kernels/rows/resistance.hpp"
#include "kernels/solver/restitution.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
struct ResistancePasses {
  static void warm_start(const Constants&, const Group&, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    for_each_resistance<S>(
        w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int, BlockList&, Resistance<S>& r) {
          RowVelocities<S, A, kDense> v(w, s), before = v;
          Float amount[S::kAng];
          for (int i = 0; i < S::kAng; ++i) amount[i] = Float::load(r.impulse[i]);
          const auto normal = load_as<typename S::Vec>(s.normal[0]);
          apply_turn(turning_sides(s), moment_of(normal, r, amount), v);
          keep_other_lanes_of_sides(mask_from_bits(r.lanes), before, v);
          v.store(w, s);
        });
  }

  static void solve(const Constants&, const Group&, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    for_each_resistance<S>(
        w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int, BlockList&, Resistance<S>& r) {
          RowVelocities<S, A, kDense> v(w, s);
          solve_resistance(s, r, v);
          v.store(w, s);
        });
  }

  // What impacts press on top of the substeps resists, too. Nothing of it is carried on.
  static void resist_impacts(Work& w) {
    const Float zero(Real(0));
    for_each_resistance<S>(
        w, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list, Resistance<S>& r) {
          const auto& bounce = bounce_at<S, N>(list, i);
          const unsigned lanes = bounce.participants & r.lanes;
          if (lanes == 0) return;
          const Mask part = mask_from_bits(lanes);
          RowVelocities<S, A, kDense> v(w, s), before = v;
          Float more = zero, none[S::kAng], after[S::kAng];
          for (int k = 0; k < N; ++k) {
            more = more + (Float::load(bounce.total[k]) - Float::load(bounce.found[k]));
          }
          for (Float& x : none) x = zero;
          resist(turning_sides(s), load_as<typename S::Vec>(s.normal[0]), r, max(more, zero), none,
                 sides_of(v), after);
          keep_other_lanes_of_sides(part, before, v);
          v.store(w, s);
          for (auto& x : r.impulse) select(part, zero, Float::load(x)).store(x);
        });
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
