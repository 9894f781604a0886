// The newton solver: accelerations that minimise
//   1/2 (a - a0)' M (a - a0) + sum of the costs of rows,   M a0 = forces,
// by Newton steps with the exact Hessian M + J' D J and an exact line search (Todorov 2014). Lanes
// that are done keep their numbers until all are. A space (joint_space.hpp, link_space.hpp) knows
// M.
#pragma once

#include "kernels/tree/constraints.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Relative to a number, a change that is none.
constexpr Real kSameStep = sizeof(Real) == 4 ? Real(2e-7) : Real(1e-15);

// The step along the search at which the cost is least: where its slope, which starts at `slope` <
// 0 and never falls, is 0, by Newton's method within the bracket found so far.
inline Float line_search(const Constants& t, const ConstraintRows& rows, Float slope,
                         const SmoothCost& smooth, Mask done) {
  constexpr Real kFar = Real(1e30);
  const kernels::NewtonOptions<Real>& options = t.tree.newton;
  const Float zero(Real(0)), enough = abs(slope) * Float(options.line_tolerance);
  Float step(Real(1)), low = zero, high(kFar);
  Mask found = done;
  for (int i = 0; i < options.line_iterations; ++i) {
    Float first = fma(step, smooth.curvature, smooth.slope), second = smooth.curvature;
    rows.along(step, first, second);
    found = found | (abs(first) <= enough);
    if (all(found)) break;
    const Mask before = first < zero;
    low = select(before & !found, step, low), high = select(before | found, high, step);
    if (i + 1 == options.line_iterations) break;
    const Float newton = step - first / second;
    const Mask inside = (low < newton) & (newton < high);
    const Float middle = select(high < Float(kFar), (low + high) * Float(Real(0.5)), step);
    const Float next = select(inside, newton, middle);
    found = found | (abs(next - step) <= abs(step) * Float(kSameStep));
    step = select(found, step, next);
  }
  return step;
}

// One problem in w.tree: its load, from the guess in w.tree.guess.
template <class Space>
class Minimiser {
 public:
  Minimiser(const Constants& t, const Group& g, const Work& w, const ConstraintRows& rows)
      : t_(t), x_(w.tree), rows_(rows), space_(t, g, w) {}

  // In the lanes of `active`. Leaves the accelerations in w.tree.guess, and in w.tree.row_load the
  // forces of the rows.
  void run(Mask active) {
    const Float tolerance(t_.tree.newton.tolerance), scale(t_.tree.newton.scale);
    space_.start(rows_);
    Mask done = !active;
    for (int i = 0; i < t_.tree.newton.iterations && !all(done); ++i) {
      rows_.look_at(bits(!done));
      space_.find_gradient(rows_);
      done = done | !(tolerance <= length_of(x_.descent) * scale);  // not a number: done, too
      if (all(done)) break;
      space_.find_direction(rows_);
      const Float slope = find_slope();
      done = done | !(tolerance <= slope * scale * Float(Real(-0.5)));
      if (all(done)) break;
      const SmoothCost smooth = space_.search(rows_);
      const Float step = select(done, Real(0), line_search(t_, rows_, slope, smooth, done));
      // Round cones have no last piece: there the search ends where steps no longer tell.
      const Mask lost = t_.tree.elliptic ? lost_in_rounding(step) : mask_from_bits(0);
      space_.advance(step, done);
      // Where no row has changed on a whole step, the cost was the quadratic that it minimises.
      const Mask whole = (Float(Real(1)) <= step) & (step <= Float(Real(1)));
      const Mask changed = rows_.advance(step, done);
      done = done | (whole & !changed) | lost;
    }
    rows_.look_at(kAllLanes);
    for_each_dof(t_, [&](int k) { Float(Real(0)).store(x_.row_load + k); });
    rows_.add_forces(x_.row_load);
  }

 private:
  Mask lost_in_rounding(Float step) const {
    Float moved(Real(0)), size(Real(0));
    for_each_dof(t_, [&](int k) {
      moved = max(moved, abs(step * Float::load(x_.direction + k)));
      size = max(size, abs(Float::load(x_.guess + k)));
    });
    return moved <= size * Float(kSameStep);
  }
  Float length_of(const Real* x) const {
    Float squares(Real(0));
    for_each_dof(t_,
                 [&](int k) { squares = fma(Float::load(x + k), Float::load(x + k), squares); });
    return sqrt(squares);
  }
  // Of the cost along the direction.
  Float find_slope() const {
    Float slope(Real(0));
    for_each_dof(t_, [&](int k) {
      slope = fnma(Float::load(x_.descent + k), Float::load(x_.direction + k), slope);
    });
    return slope;
  }

  const Constants& t_;
  const TreeWork& x_;
  ConstraintRows rows_;
  Space space_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
