// The stages of trees: semi-implicit Euler in joint coordinates, with the dampers of dofs implicit.
#include "kernels/motion/finish.hpp"
#include "kernels/tree/dynamics.hpp"
#include "kernels/tree/limits.hpp"
#include "kernels/tree/newton.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// The effective acceleration of the step, with dampers implicit, where the forces were.
void find_accelerations(const Constants& t, const Group& g, const Work& w) {
  const TreeWork& x = w.tree;
  find_poses(t, g, w);
  find_velocities(t, g, w);
  find_wrenches(t, g, w);
  project(t, g, w);
  Mask active = mask_from_bits(0);
  if (t.tree.limits > 0) {
    const LimitRows rows(t, w);
    active = rows.find(g);
    for_each_dof(t, [&](int k) { Float::load(acceleration_of(t, g, 0) + k).store(x.guess + k); });
    // Where nothing pushes the sum is the same whether other lanes have rows or not.
    for_each_dof(t, [&](int k) { Float(Real(0)).store(x.row_load + k); });
    if (any(active)) Minimiser<LimitRows>(t, w, rows).run(active);
    for_each_dof(t, [&](int k) {
      (Float::load(x.load + k) + Float::load(x.row_load + k)).store(x.load + k);
    });
  }
  if (t.tree.damped || !all(active)) {
    for (int k = 0; t.tree.damped && k < t.tree.dofs; ++k) {
      const Dof& dof = t.tree.dof[k];
      Real* diagonal = x.matrix + dof.entry * kLanes;
      fma(Float(t.dt), Float(dof.damping), Float::load(diagonal)).store(diagonal);
    }
    factorise(t, x.matrix);
    solve_factored(t, x.matrix, x.load);
  }
  if (t.tree.limits == 0) return;
  for_each_dof(t, [&](int k) {
    const Float solved = Float::load(x.load + k), guess = Float::load(x.guess + k);
    select(active, guess, solved).store(x.guess + k);
    if (!t.tree.damped) select(active, guess, solved).store(x.load + k);
  });
}

// A rotation after the angular velocity w, in its own axes, for dt.
MW_INLINE Quat rotate_for(Quat q, Vec3 w, Float dt) {
  const Float speed2 = dot(w, w), speed = sqrt(speed2), half = Float(Real(0.5)) * dt;
  const SineAndCosine part = sine_and_cosine(speed * half);
  const Mask moves = Float(Real(0)) < speed;
  const Float scale = select(moves, part.sine / select(moves, speed, Real(1)), half);
  const Vec3 v = w * scale;
  return normalize(mul(q, {part.cosine, v.x, v.y, v.z}));
}

struct Next {
  Mask good, finite;
  template <class T>
  MW_INLINE void check(T value, Real limit) {
    const Mask ok = in_range(value, limit);
    good = good & ok;
    if (!all(ok)) finite = finite & is_finite(value);
  }
};

// Velocities, then coordinates with the new velocities, into w.tree.next.
MW_INLINE Next advance(const Constants& t, const Group& g, const Work& w) {
  const Float dt(t.dt);
  Real* velocity = w.tree.next + t.tree.coordinates * kLanes;
  Next out{mask_from_bits(kAllLanes), mask_from_bits(kAllLanes)};
  for (int k = 0; k < t.tree.dofs; ++k) {
    const Float v =
        fma(Float::load(w.tree.load + k * kLanes), dt, Float::load(velocity_of(t, g, k)));
    v.store(velocity + k * kLanes);
    out.check(v, kMaxSpin);
  }
  for (int i = 0; i < t.tree.links; ++i) {
    const TreeLink& link = t.tree.link[i];
    for (int j = link.first_joint; j < link.first_joint + link.joints; ++j) {
      const TreeJoint& joint = t.tree.joint[j];
      const Real* from = coordinate_of(t, g, joint.coordinate);
      Real* to = w.tree.next + joint.coordinate * kLanes;
      const Real* v = velocity + joint.dof * kLanes;
      if (joint.kind == TreeJointKind::free) {
        const Vec3 x = fma(load_vec3(v), dt, load_vec3(from));
        store(to, x);
        out.check(x, kMaxPosition);
        from += 3 * kLanes, to += 3 * kLanes, v += 3 * kLanes;
      }
      if (kernels::coordinates_of(joint.kind) > 1) {
        const Quat before = normalize(load_quat(from));
        const Quat q = rotate_for(before, load_vec3(v), dt);
        store(to, q);
        out.check(q, kMaxOrientation);
      } else {
        const Float x = fma(Float::load(v), dt, Float::load(from));
        x.store(to);
        out.check(x, kMaxPosition);
      }
    }
  }
  return out;
}

void commit(const Constants& t, const Group& g, const Work& w, std::uint32_t lanes) {
  const Mask keep = mask_from_bits(lanes);
  const auto put = [&](const Real* from, Real* to) {
    select(keep, Float::load(from), Float::load(to)).store(to);
  };
  const Real* velocity = w.tree.next + t.tree.coordinates * kLanes;
  for (int c = 0; c < t.tree.coordinates; ++c) {
    put(w.tree.next + c * kLanes, coordinate_of(t, g, c));
  }
  for (int k = 0; k < t.tree.dofs; ++k) put(velocity + k * kLanes, velocity_of(t, g, k));
  for (int k = 0; t.tree.limits > 0 && k < t.tree.dofs; ++k) {
    put(w.tree.guess + k * kLanes, acceleration_of(t, g, k));
  }
}

// Bodies, as the state has them, from the coordinates and velocities.
void place(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  const Work& w = work_of(scratch);
  find_poses(t, g, w);
  find_velocities(t, g, w);
  for (int i = 0; i < t.tree.links; ++i) {
    const TreeLink& link = t.tree.link[i];
    const FramePose at = load_pose(w, i);
    const Vec3 c = at.x + rotate(at.q, shared(link.center));
    const Twist v = load_twist(link_rows(w.tree.velocity, i, kTwistRows));
    const Vec3 origin = load_vec3(w.tree.origin + 3 * link.root * kLanes);
    const auto put = [&](auto value, int component) {
      store(state_of(t, g, link.body, component), value);
    };
    put(origin + c, kState<Tensor>.position);
    put(mul(at.q, shared(link.principal)), kState<Tensor>.orientation);
    put(v.v + cross(v.w, c), kState<Tensor>.linear);
    put(v.w, kState<Tensor>.angular);
  }
}

void steps(const Constants& t, const Group& g, kernels::Scratch* scratch, int count) {
  const Work& w = work_of(scratch);
  for (int i = 0; i < count; ++i) {
    find_accelerations(t, g, w);
    const Next next = advance(t, g, w);
    LaneCheck check;
    check.good = next.good, check.finite = next.finite;
    commit(t, g, w, judge_lanes(g, check));
  }
  place(t, g, scratch);
}

}  // namespace

void fill_tree(kernels::TreeStages<Real>& out) { out = {steps, place}; }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
