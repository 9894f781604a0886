// The newton solver by links: M + J' D J is never made. What accelerations ask for are wrenches of
// links, and the Newton step is that of articulated bodies (articulated.hpp) in which contacts with
// the world are springs of links and limits springs of dofs; what couples branches comes on top
// (couplings.hpp). Links whose rows have not changed keep their numbers from step to step. The
// other way is joint_space.hpp.
#pragma once

#include "kernels/tree/constraints.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class LinkSpace {
 public:
  MW_INLINE LinkSpace(const Constants& t, const Group& g, const Work& w)
      : t_(t), g_(g), w_(w), x_(w.tree), bodies_(t, g, w), couplings_(t, g, w) {}

  void start(const ConstraintRows& rows) {
    find_twists(t_, w_, x_.guess, x_.rate);
    multiply(x_.rate, x_.inertial);
    rows.start(x_.guess, x_.rate);
    bodies_.make_stale(true);
    for (int i = 0; i < t_.tree.links; ++i) x_.is_held[i] = false;
  }
  // Leaves the opposite of the gradient in `direction` and `descent`.
  void find_gradient(const ConstraintRows& rows) const {
    for_each_dof(t_, [&](int k) { Float(Real(0)).store(x_.row_load + k); });
    rows.add_joint_forces(x_.row_load);
    const bool touched = !rows.contacts().none();
    if (touched) rows.contacts().find_contact_wrenches(x_.force);
    for (int i = t_.tree.links - 1; i >= 0; --i) {
      const TreeLink& link = t_.tree.link[i];
      Real* at = link_rows(x_.force, i, kTwistRows);
      Wrench f = load_wrench(link_rows(x_.inertial, i, kTwistRows));
      if (touched) f = f - load_wrench(at);
      for (int c = link.first_child; c >= 0; c = t_.tree.link[c].next_child) {
        f = f + load_wrench(link_rows(x_.force, c, kTwistRows));
      }
      if (link.parent >= 0) store(at, to_parent(w_, i, f));
      for (int k = link.first_dof; k < link.first_dof + link.dofs; ++k) {
        const Float own =
            Float(constants_of_dof(g_, k).armature) * Float::load(x_.guess + k * kLanes);
        const Float smooth =
            (dot(load_twist(axis_of(w_, k)), f) + own) - Float::load(x_.load + k * kLanes);
        const Float down = Float(Real(0)) - (smooth - Float::load(x_.row_load + k * kLanes));
        down.store(x_.direction + k * kLanes), down.store(x_.descent + k * kLanes);
      }
    }
  }
  // From there to the Newton step.
  void find_direction(const ConstraintRows& rows) {
    for_each_dof(t_, [&](int k) { Float(Real(0)).store(x_.diagonal + k); });
    rows.add_stiffness(x_.diagonal);
    rows.hold();
    bodies_.factorise(x_.diagonal);
    bodies_.make_stale(false);
    couplings_.clear();
    rows.add_rows(couplings_);
    bodies_.reduce(x_.direction);
    if (couplings_.any()) couplings_.correct(x_.direction);
    bodies_.expand(x_.direction, x_.rate);
  }
  SmoothCost search(const ConstraintRows& rows) const {
    multiply(x_.rate, x_.inertial_along);
    rows.search(x_.direction, x_.rate);
    SmoothCost out{Real(0), Real(0)};
    for (int i = 0; i < t_.tree.links; ++i) {
      const Twist v = load_twist(link_rows(x_.rate, i, kTwistRows));
      out.slope = out.slope + dot(v, load_wrench(link_rows(x_.inertial, i, kTwistRows)));
      out.curvature =
          out.curvature + dot(v, load_wrench(link_rows(x_.inertial_along, i, kTwistRows)));
    }
    for (int k = 0; k < t_.tree.dofs; ++k) {
      const Float d = Float::load(x_.direction + k * kLanes);
      const Float armature = constants_of_dof(g_, k).armature;
      const Float asked = armature * Float::load(x_.guess + k * kLanes);
      out.slope = fma(d, asked - Float::load(x_.load + k * kLanes), out.slope);
      out.curvature = fma(armature * d, d, out.curvature);
    }
    return out;
  }
  void advance(Float step, Mask done) const {
    const auto go = [&](Real* to, const Real* way, int rows) {
      for (int r = 0; r < rows * kLanes; r += kLanes) {
        const Float from = Float::load(to + r);
        select(done, from, fma(step, Float::load(way + r), from)).store(to + r);
      }
    };
    go(x_.guess, x_.direction, t_.tree.dofs);
    go(x_.inertial, x_.inertial_along, kTwistRows * t_.tree.links);
  }

 private:
  // Inertias of links times twists.
  void multiply(const Real* twists, Real* wrenches) const {
    for (int i = 0; i < t_.tree.links; ++i) {
      const SpatialInertia inertia = load_inertia(link_rows(x_.inertia, i, kInertiaRows));
      const Twist v = load_twist(twists + i * kTwistRows * kLanes);
      store(link_rows(wrenches, i, kTwistRows), mul(inertia, v));
    }
  }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
  const TreeWork& x_;
  const ArticulatedBodies bodies_;
  Couplings couplings_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
