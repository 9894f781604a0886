// The newton solver: accelerations that minimise
//   1/2 (a - a0)' M (a - a0) + sum of the costs of rows,   M a0 = forces,
// by Newton steps with the exact Hessian M + J' D J and an exact line search (Todorov 2014). Lanes
// that are done keep their numbers until all are.
#pragma once

#include "kernels/tree/factor.hpp"
#include "kernels/tree/stiffness.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Relative to a number, a change that is none.
constexpr Real kSameStep = sizeof(Real) == 4 ? Real(2e-7) : Real(1e-15);

// visit(row of dof k) of [dof][lane] arrays.
template <class Visit>
MW_INLINE void for_each_dof(const Constants& t, Visit visit) {
  for (int k = 0; k < t.tree.dofs; ++k) visit(k * kLanes);
}

// The step along the search at which the cost is least: where its slope, which starts at `slope` <
// 0 and never falls, is 0, by Newton's method within the bracket found so far.
template <class Rows>
MW_INLINE Float line_search(const Constants& t, const Rows& rows, Float slope, Float own_slope,
                            Float own_curvature, Mask done) {
  constexpr Real kFar = Real(1e30);
  const kernels::NewtonOptions<Real>& options = t.tree.newton;
  const Float zero(Real(0)), enough = abs(slope) * Float(options.line_tolerance);
  Float step(Real(1)), low = zero, high(kFar);
  Mask found = done;
  for (int i = 0; i < options.line_iterations; ++i) {
    Float first = fma(step, own_curvature, own_slope), second = own_curvature;
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

// One problem in w.tree: its matrix and load, from the guess in w.tree.guess.
template <class Rows>
class Minimiser {
 public:
  Minimiser(const Constants& t, const Work& w, const Rows& rows)
      : t_(t), x_(w.tree), rows_(rows), stiffness_(t, w), scale_(t.tree.newton.scale) {}

  // In the lanes of `active`. Leaves the accelerations in w.tree.guess, and in w.tree.row_load what
  // the rows push with.
  void run(Mask active) {
    multiply(t_, x_.matrix, x_.guess, x_.balance);
    rows_.start(x_.guess);
    stiffness_.forget_pattern();
    const Float tolerance(t_.tree.newton.tolerance);
    Mask done = !active;
    for (int i = 0; i < t_.tree.newton.iterations && !all(done); ++i) {
      rows_.look_at(bits(!done));
      find_forces();
      done = done | !(tolerance <= find_gradient() * scale_);  // not a number: done, too
      if (all(done)) break;
      const Float slope = find_direction();
      done = done | !(tolerance <= slope * scale_ * Float(Real(-0.5)));
      if (all(done)) break;
      const Float step = select(done, Real(0), find_step(slope, done));
      // Round cones have no last piece: there the search ends where steps no longer tell.
      const Mask lost = t_.tree.elliptic ? lost_in_rounding(step) : mask_from_bits(0);
      for_each_dof(t_, [&](int k) {
        const auto go = [&](Real* to, const Real* way) {
          const Float from = Float::load(to + k);
          select(done, from, fma(step, Float::load(way + k), from)).store(to + k);
        };
        go(x_.guess, x_.direction), go(x_.balance, x_.reach);
      });
      // Where no row has changed on a whole step, the cost was the quadratic that it minimises.
      const Mask whole = (Float(Real(1)) <= step) & (step <= Float(Real(1)));
      const Mask changed = rows_.advance(step, done);
      done = done | (whole & !changed) | lost;
    }
    rows_.look_at(kAllLanes);
    find_forces();
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
  void find_forces() {
    for_each_dof(t_, [&](int k) { Float(Real(0)).store(x_.row_load + k); });
    rows_.add_forces(x_.row_load);
  }
  // Leaves its opposite in `direction` and `reach`; returns its length.
  Float find_gradient() {
    Float squares(Real(0));
    for_each_dof(t_, [&](int k) {
      const Float smooth = Float::load(x_.balance + k) - Float::load(x_.load + k);
      const Float gradient = smooth - Float::load(x_.row_load + k);
      squares = fma(gradient, gradient, squares);
      const Float down = Float(Real(0)) - gradient;  // never -0
      down.store(x_.direction + k), down.store(x_.reach + k);
    });
    return sqrt(squares);
  }
  // The Newton step; returns the slope of the cost along it.
  Float find_direction() {
    stiffness_.begin_pattern();
    rows_.couple(stiffness_);
    stiffness_.fill_pattern();
    stiffness_.start(x_.matrix);
    rows_.add_stiffness(stiffness_);
    stiffness_.factorise();
    stiffness_.solve(x_.direction);
    Float slope(Real(0));
    for_each_dof(t_, [&](int k) {
      slope = fnma(Float::load(x_.reach + k), Float::load(x_.direction + k), slope);
    });
    return slope;
  }
  Float find_step(Float slope, Mask done) {
    multiply(t_, x_.matrix, x_.direction, x_.reach);
    rows_.search(x_.direction);
    Float own_slope(Real(0)), own_curvature(Real(0));
    for_each_dof(t_, [&](int k) {
      const Float d = Float::load(x_.direction + k);
      own_slope = fma(d, Float::load(x_.balance + k) - Float::load(x_.load + k), own_slope);
      own_curvature = fma(d, Float::load(x_.reach + k), own_curvature);
    });
    return line_search(t_, rows_, slope, own_slope, own_curvature, done);
  }

  const Constants& t_;
  const TreeWork& x_;
  Rows rows_;
  const Stiffness stiffness_;
  Float scale_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
