// The newton solver in joint space: M as a matrix, and M + J' D J factorised. For plans in which
// trees press on each other, whose rows are more than their dofs, or links of a robot can in more
// ways than there is room for, and for those of few dofs. The other way is link_space.hpp.
#pragma once

#include "kernels/tree/constraints.hpp"
#include "kernels/tree/factor.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class JointSpace {
 public:
  MW_INLINE JointSpace(const Constants& t, const Group&, const Work& w)
      : t_(t), w_(w), x_(w.tree), stiffness_(t, w) {}

  void start(const ConstraintRows& rows) const {
    multiply(t_, x_.matrix, x_.guess, x_.balance);
    stiffness_.forget_pattern();
    rows.start(x_.guess, twists_of(rows, x_.guess));
  }
  // Leaves the opposite of the gradient in `direction` and `descent`.
  void find_gradient(const ConstraintRows& rows) const {
    for_each_dof(t_, [&](int k) { Float(Real(0)).store(x_.row_load + k); });
    rows.add_forces(x_.row_load);
    for_each_dof(t_, [&](int k) {
      const Float smooth = Float::load(x_.balance + k) - Float::load(x_.load + k);
      const Float gradient = smooth - Float::load(x_.row_load + k);
      const Float down = Float(Real(0)) - gradient;  // never -0
      down.store(x_.direction + k), down.store(x_.descent + k);
    });
  }
  // From there to the Newton step.
  void find_direction(const ConstraintRows& rows) const {
    stiffness_.begin_pattern();
    rows.couple(stiffness_);
    stiffness_.fill_pattern();
    stiffness_.start(x_.matrix);
    rows.add_stiffness(stiffness_);
    stiffness_.factorise();
    stiffness_.solve(x_.direction);
  }
  SmoothCost search(const ConstraintRows& rows) const {
    multiply(t_, x_.matrix, x_.direction, x_.reach);
    rows.search(x_.direction, twists_of(rows, x_.direction));
    SmoothCost out{Real(0), Real(0)};
    for_each_dof(t_, [&](int k) {
      const Float d = Float::load(x_.direction + k);
      const Float smooth = Float::load(x_.balance + k) - Float::load(x_.load + k);
      out.slope = fma(d, smooth, out.slope);
      out.curvature = fma(d, Float::load(x_.reach + k), out.curvature);
    });
    return out;
  }
  void advance(Float step, Mask done) const {
    for_each_dof(t_, [&](int k) {
      const auto go = [&](Real* to, const Real* way) {
        const Float from = Float::load(to + k);
        select(done, from, fma(step, Float::load(way + k), from)).store(to + k);
      };
      go(x_.guess, x_.direction), go(x_.balance, x_.reach);
    });
  }

 private:
  const Real* twists_of(const ConstraintRows& rows, const Real* a) const {
    if (!rows.contacts().none()) find_twists(t_, w_, a, x_.rate);
    return x_.rate;
  }

  const Constants& t_;
  const Work& w_;
  const TreeWork& x_;
  const Stiffness stiffness_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
