// The solves over trees of joints in the order of a substep. One instantiation per space and layout
// fills a DirectSolver.
#pragma once

#include "kernels/direct/attached_rows.hpp"
#include "kernels/direct/contacts.hpp"
#include "kernels/direct/solve.hpp"
#include "kernels/direct/stiffness.hpp"
#include "kernels/direct/tree_compliances.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
struct DirectPasses {
  static void begin(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    w.direct.located = 0;
    for (int b = 0; b < t.bodies; ++b) w.direct.held[b] = 0;
    find_moments<S>(t, g, w);
    for (int i = 0; i < t.joint_trees.edges + t.joint_trees.closures; ++i) {
      const TreeEdge& edge = t.joint_trees.edge[i];
      const std::uint32_t lanes = part_rows<S, PartBodies<S>>(w, edge.hold).mask;
      w.direct.held[edge.child] |= lanes;
      if (!edge.prescribed) w.direct.held[edge.parent] |= lanes;
    }
    w.direct.factored.place = -1, w.direct.is_stiff = false;
    biased(t, g, w, false).guess_active_sets();
  }

  static void bias(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    const EdgeFinder<S, kDense> finder(t, g, w);
    if (w.direct.located != w.substep) finder.refresh_parts();
    finder.template find<true>();
    w.direct.is_stiff = GeometricStiffness<S>(t, g, w).find();
    if (w.direct.is_stiff) find_touched(t, g, w);
    biased(t, g, w, true).run();
  }
  static void bias_again(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    biased(t, g, work_of(scratch), false).run_again();
  }
  static void relax(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    const EdgeFinder<S, kDense> finder(t, g, w);
    finder.refresh_parts();
    finder.template find<false>();
    w.direct.located = w.substep + 1;
    relaxed(t, g, w).run();
  }
  static void relax_again(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    relaxed(t, g, work_of(scratch)).run_again();
  }

  // Attached rows, and then contacts, act on trees where those were when the substep began, and
  // in the relaxing pass where it has taken them. That is where the next substep begins: effective
  // masses hold for both, unless limits and drives tell the solves apart.
  template <Pass kPass, bool kAgain>
  static void open(const Constants& t, const Group& g, Work& w) {
    TreeFactors<S> factors = factors_in<S>(w.direct.of_solves);
    if (find_touched(t, g, w)) {
      const bool first = kPass == Pass::bias && !kAgain && w.substep == 0;
      if (first && t.has_contacts) find_tree_masses(t, g, w);
      const TreeSolve<S, kDense> solve =
          kPass == Pass::bias ? biased(t, g, w, false) : relaxed(t, g, w);
      const bool moved = first || (kPass == Pass::relax && !kAgain);
      const bool weighs = moved || t.joint_trees.bounded;
      if (weighs && t.joint_trees.attached > 0) {
        const TreeFactors<S> yielding = solve.factor_without_bounds();
        TreeCompliances<S>(t, w, yielding).find();
        AttachedRows<S, kDense>(t, g, w).weigh(yielding);
      }
      factors = solve.factor_for_contacts();
      if (weighs && (t.joint_trees.bounded || t.joint_trees.attached == 0)) {
        TreeCompliances<S>(t, w, factors).find();
      }
      if (weighs && t.has_contacts) TreeContacts<S, kDense>(t, w).template weigh<true>();
    }
    w.direct.of_round = {reinterpret_cast<unsigned char*>(factors.edge), factors.inertia};
    response(t, w).open();
  }
  template <Pass kPass, bool kAgain>
  static void rows(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    open<kPass, kAgain>(t, g, w);
    AttachedRows<S, kDense>(t, g, w).template solve<kPass>(response(t, w));
  }
  template <Pass kPass, bool kAgain>
  static void contacts(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    Work& w = work_of(scratch);
    if (t.joint_trees.attached == 0) open<kPass, kAgain>(t, g, w);
    TreeContacts<S, kDense>(t, w).template solve<kPass>(response(t, w));
  }
  // What the relaxing pass did counts for restitution.
  template <bool kAgain>
  static void relax_contacts(const Constants& t, const Group& g, kernels::Scratch* scratch) {
    contacts<Pass::relax, kAgain>(t, g, scratch);
    if (t.has_restitution && kAgain == t.joint_trees.bounded) {
      TreeContacts<S, kDense>(t, work_of(scratch)).accumulate_bounces();
    }
  }
  static void weigh_alone(const Constants& t, const Group&, kernels::Scratch* scratch) {
    TreeContacts<S, kDense>(t, work_of(scratch)).template weigh<false>();
  }

  static kernels::DirectSolver<Real> table() {
    return {begin,
            bias,
            relax,
            {rows<Pass::bias, false>, rows<Pass::bias, true>, contacts<Pass::bias, false>,
             contacts<Pass::bias, true>, bias_again},
            {rows<Pass::relax, false>, rows<Pass::relax, true>, relax_contacts<false>,
             relax_contacts<true>, relax_again},
            weigh_alone};
  }

 private:
  // Marks the bodies of trees that contacts or rows are on, and those that they hang on; whether
  // there are any.
  static bool find_touched(const Constants& t, const Group& g, Work& w) {
    if (!are_loaded(t)) return false;
    std::uint32_t* touched = w.direct.touched;
    for (int b = 0; b <= t.bodies; ++b) touched[b] = 0;
    std::uint32_t some = 0;
    const auto touch = [&](int body, std::uint32_t lanes) {
      const std::uint32_t held = w.direct.held[body] & lanes;
      touched[body] |= held, some |= held;
    };
    if (t.has_contacts) TreeContacts<S, kDense>(t, w).for_each_end(touch);
    if (t.joint_trees.attached > 0) AttachedRows<S, kDense>(t, g, w).for_each_end(touch);
    for (int i = t.joint_trees.edges - 1; some != 0 && i >= 0; --i) {
      const TreeEdge& edge = t.joint_trees.edge[i];
      if (!edge.prescribed) touched[edge.parent] |= touched[edge.child];
    }
    return some != 0;
  }
  static TreeResponse<S, kDense> response(const Constants& t, Work& w) {
    return {t, w, factors_in<S>(w.direct.of_round)};
  }
  static TreeSolve<S, kDense> biased(const Constants& t, const Group& g, Work& w, bool first) {
    return {t, g, w, w.substep, w.direct.is_stiff, true, first};
  }
  static TreeSolve<S, kDense> relaxed(const Constants& t, const Group& g, Work& w) {
    return {t, g, w, w.substep + 1, false, false, false};
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
