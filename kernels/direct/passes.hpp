// The solves over trees of joints in the order of a substep. One instantiation per space and layout
// fills a DirectSolver.
#pragma once

#include "kernels/direct/solve.hpp"
#include "kernels/direct/stiffness.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
struct DirectPasses {
  static void begin(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    w.direct.located = 0;
    for (int i = 0; i < t.joint_trees.bodies; ++i) {
      const int b = t.joint_trees.body[i];
      w.direct.held[b] = 0;
      put_moments(t, g, w, b);
    }
    for (int i = 0; i < t.joint_trees.edges; ++i) {
      const TreeEdge& edge = t.joint_trees.edge[i];
      const std::uint32_t lanes = part_rows<S, PartBodies<S>>(w, edge.hold).mask;
      w.direct.held[edge.child] |= lanes;
      if (!edge.prescribed) w.direct.held[edge.parent] |= lanes;
    }
    TreeSolve<S, kDense>(t, g, w, w.direct.rotary, true, false).guess_active_sets();
  }

  static void bias(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    const EdgeFinder<S, kDense> finder(t, g, w);
    if (w.direct.located != w.substep) finder.refresh_parts();
    finder.template find<true>();
    GeometricStiffness<S>(t, g, w).find();
    TreeSolve<S, kDense>(t, g, w, w.direct.stiffened, true, true).run(w.direct.rotary);
  }
  static void bias_again(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    TreeSolve<S, kDense>(t, g, w, w.direct.stiffened, true, false).run(w.direct.stiffened);
  }
  static void relax(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    const EdgeFinder<S, kDense> finder(t, g, w);
    finder.refresh_parts();
    finder.template find<false>();
    w.direct.located = w.substep + 1;
    relax_again(t, g, scratch);
  }
  static void relax_again(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    TreeSolve<S, kDense>(t, g, w, w.direct.rotary, false, false).run(w.direct.rotary);
  }

  static kernels::DirectSolver<Real> table() {
    return {begin, bias, bias_again, relax, relax_again};
  }

 private:
  static MW_INLINE void put_moments(const Constants& t, const Group& g, Work& w, int b) {
    const auto& constants = constants_of_body(g, b);
    Real* to = w.direct.rotary + b * S::kInertia * kLanes;
    if constexpr (S::kDim == 2) {
      Float(constants.inertia[2]).store(to);
    } else {
      const Quat q = load_quat(state_of(t, g, b, kState<S>.orientation));
      store(to, rotate_diagonal(
                    matrix(q), {constants.inertia[0], constants.inertia[1], constants.inertia[2]}));
    }
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
