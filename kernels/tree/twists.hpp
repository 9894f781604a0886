// What numbers of dofs do to links, and what wrenches on links do to dofs: J and J' of all links.
#pragma once

#include "kernels/tree/dynamics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Motions of links by accelerations, [dof][lane].
inline void find_twists(const Constants& t, const Work& w, const Real* x, Real* twists) {
  for (int i = 0; i < t.tree.links; ++i) {
    const TreeLink& link = t.tree.link[i];
    Twist v{zero_of<Vec3>(), zero_of<Vec3>()};
    if (link.parent >= 0) {
      v = from_parent(w, i, load_twist(link_rows(twists, link.parent, kTwistRows)));
    }
    for (int k = link.first_dof; k < link.first_dof + link.dofs; ++k) {
      v = fma(load_twist(axis_of(w, k)), Float::load(x + k * kLanes), v);
    }
    store(link_rows(twists, i, kTwistRows), v);
  }
}

// Adds to [dof][lane] what wrenches on the links do there. They are added up on the way.
inline void add_wrenches(const Constants& t, const Work& w, Real* wrenches, Real* load) {
  for (int i = t.tree.links - 1; i >= 0; --i) {
    const TreeLink& link = t.tree.link[i];
    const Wrench f = load_wrench(link_rows(wrenches, i, kTwistRows));
    for (int k = link.first_dof; k < link.first_dof + link.dofs; ++k) {
      Real* to = load + k * kLanes;
      (Float::load(to) + dot(load_twist(axis_of(w, k)), f)).store(to);
    }
    if (link.parent < 0) continue;
    Real* below = link_rows(wrenches, link.parent, kTwistRows);
    store(below, load_wrench(below) + to_parent(w, i, f));
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
