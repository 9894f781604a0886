// The stages of trees: semi-implicit Euler in joint coordinates, with dampers of dofs and what else
// is implicit (implicit.hpp) at the end of the step, or Runge-Kutta.
#include "kernels/tree/ball_springs.hpp"
#include "kernels/tree/implicit.hpp"
#include "kernels/tree/joint_space.hpp"
#include "kernels/tree/link_space.hpp"
#include "kernels/tree/newton.hpp"
#include "kernels/tree/runge_kutta.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// (M + diagonal) a = load, in place.
void solve_smooth(const Constants& t, const Group& g, const Work& w) {
  const TreeWork& x = w.tree;
  if (t.tree.by_links) {
    const ArticulatedBodies bodies(t, g, w);
    for (int i = 0; i < t.tree.links; ++i) x.is_held[i] = false;
    bodies.make_stale(true);
    bodies.factorise(x.diagonal);
    bodies.reduce(x.load);
    bodies.expand(x.load, x.rate);
    return;
  }
  for (int k = 0; k < t.tree.dofs; ++k) {
    Real* own = x.matrix + t.tree.dof[k].entry * kLanes;
    (Float::load(own) + Float::load(x.diagonal + k * kLanes)).store(own);
  }
  factorise(t, x.matrix);
  solve_factored(t, x.matrix, x.load);
}

// The effective acceleration of the substep, with dampers implicit, where the forces were. Where
// links are is known.
void find_accelerations(const Constants& t, const Group& g, const Work& w) {
  const TreeWork& x = w.tree;
  find_velocities(t, g, w);
  find_wrenches(t, g, w);
  project_wrenches(t, g, w);
  if (!t.tree.by_links) find_matrix(t, g, w);
  add_ball_springs(t, g, w);
  add_actuators(t, g, w);
  Mask active = mask_from_bits(0);
  if (t.tree.has_rows) {
    const ConstraintRows rows(t, w);
    active = rows.find(g) & !mask_from_bits(frozen_lanes(g));
    for (int k = 0; k < t.tree.dofs; ++k) {
      Float::load(acceleration_of(t, g, k)).store(x.guess + k * kLanes);
    }
    // Where no row is active the sum is the same whether other lanes have rows or not.
    for_each_dof(t, [&](int k) { Float(Real(0)).store(x.row_load + k); });
    if (any(active)) {
      t.tree.by_links ? Minimiser<LinkSpace>(t, g, w, rows).run(active)
                      : Minimiser<JointSpace>(t, g, w, rows).run(active);
    }
    for_each_dof(t, [&](int k) {
      (Float::load(x.load + k) + Float::load(x.row_load + k)).store(x.load + k);
    });
  }
  if (t.tree.damped || !all(active)) {
    for (int k = 0; k < t.tree.dofs; ++k) {
      const Float damping = t.tree.damped ? Float(constants_of_dof(g, k).damping) : Float(Real(0));
      (Float(t.h) * damping).store(x.diagonal + k * kLanes);
    }
    if (t.tree.implicit) {
      add_resistance(t, g, w);
      for_each_free_link(t, [&](int i) { FreeLink(t, w, i).solve(x.load, x.free); });
    }
    solve_smooth(t, g, w);
    if (t.tree.implicit) {
      for_each_free_link(t, [&](int i) {
        const int first = t.tree.link[i].first_dof;
        for (int k = first; k < first + 6; ++k) {
          Float::load(x.free + k * kLanes).store(x.load + k * kLanes);
        }
      });
    }
  }
  if (!t.tree.has_rows) return;
  for_each_dof(t, [&](int k) {
    const Float solved = Float::load(x.load + k), guess = Float::load(x.guess + k);
    select(active, guess, solved).store(x.guess + k);
    if (!t.tree.damped) select(active, guess, solved).store(x.load + k);
  });
}

// Semi-implicit Euler: velocities, then coordinates with the new velocities.
Next advance(const Constants& t, const Group& g, const Work& w) {
  Real* velocity = w.tree.next + t.tree.coordinates * kLanes;
  Next out;
  for (int k = 0; k < t.tree.dofs; ++k) {
    const Float v =
        fma(Float::load(w.tree.load + k * kLanes), Float(t.h), Float::load(velocity_of(t, g, k)));
    v.store(velocity + k * kLanes);
    out.check(v, kMaxSpin);
    // Rows at an acceleration that is NaN have no force, so velocities do not show it.
    if (t.tree.has_rows) out.check(Float::load(w.tree.guess + k * kLanes), kMaxAcceleration);
  }
  integrate(t, coordinate_of(t, g, 0), velocity, Float(t.h), w.tree.next, out);
  return out;
}

template <class T>
void put_body(const Constants& t, const Group& g, int body, int component, T value) {
  store(state_of(t, g, body, component), value);
}
// From a link's frame to its centre of mass.
MW_INLINE Vec3 arm_of(const Group& g, int link, const FramePose& at) {
  return rotate(at.q, of_lanes(constants_of_link(g, link).center));
}
void put_pose(const Constants& t, const Group& g, const Work& w, int index, const FramePose& at,
              Vec3 arm) {
  const TreeLink& link = t.tree.link[index];
  const Vec3 origin = load_vec3(w.tree.origin + 3 * link.root * kLanes);
  const Quat principal = of_lanes(constants_of_link(g, index).principal);
  put_body(t, g, link.body, kState<Tensor>.position, origin + (at.x + arm));
  put_body(t, g, link.body, kState<Tensor>.orientation, mul(at.q, principal));
}

// Bodies, as the state has them, from the coordinates and velocities.
void place(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  const Work& w = work_of(scratch);
  find_poses(t, g, w);
  find_velocities(t, g, w);
  for (int i = 0; i < t.tree.links; ++i) {
    const TreeLink& link = t.tree.link[i];
    const FramePose at = load_pose(w, i);
    const Vec3 arm = arm_of(g, i, at);
    const Twist v = load_twist(link_rows(w.tree.velocity, i, kTwistRows));
    put_pose(t, g, w, i, at, arm);
    put_body(t, g, link.body, kState<Tensor>.linear, v.v + cross(v.w, arm));
    put_body(t, g, link.body, kState<Tensor>.angular, v.w);
  }
}

void pose(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  const Work& w = work_of(scratch);
  find_poses(t, g, w);
  for (int i = 0; i < t.tree.links; ++i) {
    const FramePose at = load_pose(w, i);
    put_pose(t, g, w, i, at, arm_of(g, i, at));
  }
}

void step(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  const Work& w = work_of(scratch);
  find_accelerations(t, g, w);
  const Next next = advance(t, g, w);
  LaneCheck check;
  check.good = next.good, check.finite = next.finite;
  commit(t, g, w, judge_lanes(g, check));
}

template <int kStage>
void runge_kutta(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  const Work& w = work_of(scratch);
  find_accelerations(t, g, w);
  RungeKutta(t, g, w).go_on(kStage);
}

constexpr kernels::Stage<Real> kRungeKutta[] = {runge_kutta<0>, runge_kutta<1>, runge_kutta<2>,
                                                runge_kutta<3>};

void steps(const Constants& t, const Group& g, kernels::Scratch* scratch, int count) {
  for (int i = 0; i < count; ++i) {
    for (int s = 0; s < t.tree.stages; ++s) {
      find_poses(t, g, work_of(scratch));
      t.tree.stages == 1 ? step(t, g, scratch) : kRungeKutta[s](t, g, scratch);
    }
  }
  place(t, g, scratch);
}

}  // namespace

void fill_tree(kernels::TreeStages<Real>& out) {
  out.steps = steps, out.pose = pose, out.step = step, out.place = place;
  for (int s = 0; s < 4; ++s) out.runge_kutta[s] = kRungeKutta[s];
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
