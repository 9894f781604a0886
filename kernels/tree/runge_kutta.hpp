// The classical Runge-Kutta method of fourth order in joint coordinates. Each of its stages finds
// contacts, limits and accelerations anew. Rotations go by Munthe-Kaas: an angular velocity at a
// stage, which is that of a frame already rotated by u, counts as the rate of u (Hairer, Lubich,
// Wanner 2006, IV.8).
#pragma once

#include "kernels/tree/integrate.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// The rate of u where the frame that exp(u) leads to has the angular velocity w in its own axes.
// The series of its inverse differential ends where the method's order does.
MW_INLINE Vec3 rate_of_rotation(Vec3 u, Vec3 w) {
  const Vec3 once = cross(u, w), twice = cross(u, once);
  return fma(twice, Float(Real(1) / Real(12)), fma(once, Float(Real(0.5)), w));
}

class RungeKutta {
 public:
  RungeKutta(const Constants& t, const Group& g, const Work& w) : t_(t), g_(g), w_(w) {}

  // After the accelerations of a stage, 0 to 3, are in w.tree.load: goes on to the state of the
  // next one, or to the end of the step.
  void go_on(int stage) const {
    if (stage == 0) remember();
    constexpr Real kWeight[] = {Real(1) / 6, Real(1) / 3, Real(1) / 3, Real(1) / 6};
    constexpr Real kReach[] = {Real(0.5), Real(0.5), Real(1)};
    find_rates(stage);
    const Float weight(kWeight[stage]);
    for (int r = 0; r < rows(); r += kLanes) {
      const Float rate = Float::load(x().stage_rate + r), sum = Float::load(x().rate_sum + r);
      (stage == 0 ? rate * weight : fma(rate, weight, sum)).store(x().rate_sum + r);
    }
    if (stage < 3) return move(x().stage_rate, Float(kReach[stage] * t_.h));
    finish();
  }

 private:
  const TreeWork& x() const { return w_.tree; }
  int rows() const { return 2 * t_.tree.dofs * kLanes; }  // rates of coordinates, then velocities

  void remember() const {
    for (int c = 0; c < t_.tree.coordinates; ++c) {
      Float::load(coordinate_of(t_, g_, c)).store(x().start + c * kLanes);
    }
    for (int k = 0; k < t_.tree.dofs; ++k) {
      Real* to = x().start + (t_.tree.coordinates + k) * kLanes;
      Float::load(velocity_of(t_, g_, k)).store(to);
      Float(Real(0)).store(x().displacement + k * kLanes);
    }
  }
  void find_rates(int stage) const {
    const int dofs = t_.tree.dofs;
    for (int k = 0; k < dofs; ++k) {
      Float::load(velocity_of(t_, g_, k)).store(x().stage_rate + k * kLanes);
      Float::load(x().load + k * kLanes).store(x().stage_rate + (dofs + k) * kLanes);
    }
    for_each_joint(t_, [&](const TreeJoint& joint) {
      if (stage == 0 || kernels::coordinates_of(joint.kind) == 1) return;
      const int first = joint.dof + (joint.kind == TreeJointKind::free ? 3 : 0);
      Real* rate = x().stage_rate + first * kLanes;
      store(rate, rate_of_rotation(load_vec3(x().displacement + first * kLanes), load_vec3(rate)));
    });
  }
  // To the start, moved at these rates for dt.
  void move(const Real* rates, Float dt) const {
    Next all;
    integrate(t_, x().start, rates, dt, coordinate_of(t_, g_, 0), all);
    const int dofs = t_.tree.dofs;
    for (int k = 0; k < dofs; ++k) {
      (Float::load(rates + k * kLanes) * dt).store(x().displacement + k * kLanes);
      const Float from = Float::load(x().start + (t_.tree.coordinates + k) * kLanes);
      fma(Float::load(rates + (dofs + k) * kLanes), dt, from).store(velocity_of(t_, g_, k));
    }
  }
  void finish() const {
    const Float h(t_.h);
    const int dofs = t_.tree.dofs, coordinates = t_.tree.coordinates;
    Next next;
    integrate(t_, x().start, x().rate_sum, h, x().next, next);
    for (int k = 0; k < dofs; ++k) {
      const Float from = Float::load(x().start + (coordinates + k) * kLanes);
      const Float v = fma(Float::load(x().rate_sum + (dofs + k) * kLanes), h, from);
      v.store(x().next + (coordinates + k) * kLanes);
      next.check(v, kMaxSpin);
      if (t_.tree.has_rows) next.check(Float::load(x().guess + k * kLanes), kMaxAcceleration);
      from.store(velocity_of(t_, g_, k));
    }
    for (int c = 0; c < coordinates; ++c) {
      Float::load(x().start + c * kLanes).store(coordinate_of(t_, g_, c));
    }
    LaneCheck check;
    check.good = next.good, check.finite = next.finite;
    commit(t_, g_, w_, judge_lanes(g_, check));
  }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
