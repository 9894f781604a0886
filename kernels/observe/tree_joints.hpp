// Coordinates of joints of trees, from the generalised ones; and what the joints carry: the wrench
// that a link's motion in the last stage asks for, less what acts on it from outside, added up from
// the tips (recursive Newton-Euler, Featherstone 2008, 5.3; MuJoCo's cfrc_int).
#pragma once

#include "kernels/joint/coordinates.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/observe/tree_links.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Cone or twist of a ball, which are of its frames' z axes, in the link's axes.
MW_INLINE void observe_ball(const Constants& t, const Group& g, const TreeJoint& joint,
                            PartKind kind, Real* rows) {
  const Quat q = normalize(load_quat(coordinate_of(t, g, joint.coordinate)));
  const auto turn = [&](int k) { return Float::load(velocity_of(t, g, joint.dof + k)); };
  const Vec3 w{turn(0), turn(1), turn(2)};
  const Vec3 z_b = shared(joint.axis), z_a = rotate_back(q, z_b);
  const Float along = dot(z_a, z_b);
  Float value, speed;
  if (kind == PartKind::cone) {
    Float length;
    const Vec3 lean = direction_of(cross(z_a, z_b), length);
    value = arc_tangent(length, along);
    speed = dot(select(Float(Real(1e-6)) < length, lean, any_tangent(z_a)), w);
  } else {
    // Of 2 atan(q . z / w), of the rotation q of B against A.
    speed = dot(z_a + z_b, w) / max(Float(Real(1)) + along, Real(1e-6));
    const Float half = arc_tangent(copysign(Real(1), q.w) * dot({q.x, q.y, q.z}, z_b), abs(q.w));
    value = half + half;
  }
  value.store(rows + row_of(Observed::joint_position) * kLanes);
  speed.store(rows + row_of(Observed::joint_speed) * kLanes);
}

inline void observe_tree_joints(const Constants& t, const Group& g, const ObserverView& o) {
  for (int i = 0; i < items_of(o, Observer::joints); ++i) {
    const kernels::JointCoordinate& c = o.coordinate[i];
    const TreeJoint& joint = t.tree.joint[c.part];
    Real* rows = rows_for(o, Observer::joints) + i * rows_of(Observer::joints) * kLanes;
    if (joint.kind == TreeJointKind::ball) {
      observe_ball(t, g, joint, c.what.kind, rows);
      continue;
    }
    Float::load(coordinate_of(t, g, joint.coordinate))
        .store(rows + row_of(Observed::joint_position) * kLanes);
    Float::load(velocity_of(t, g, joint.dof)).store(rows + row_of(Observed::joint_speed) * kLanes);
  }
}

// Before the last stage of a call: where it begins.
inline void keep_tree_state(const Constants& t, const Group& g, kernels::Scratch*,
                            const ObserverView& o) {
  for (int r = 0; r < t.state_size; ++r) {
    Float::load(g.state + r * kLanes).store(o.before + r * kLanes);
  }
}

class TreeLoads {
 public:
  // After a stage that began with `before`: poses, the accelerations of the dofs and the forces of
  // contacts are in the scratch.
  TreeLoads(const Constants& t, const Group& before, const Work& w) : t_(t), g_(before), w_(w) {}

  // Leaves in w.tree.force, about the frame of each link, what it gets from its joints.
  void find() const {
    find_velocities(t_, g_, w_);
    add_accelerations();
    find_wrenches(t_, g_, w_);
    if (t_.has_contacts) take_contacts();
    for (int i = t_.tree.links - 1; i >= 0; --i) {
      const int parent = t_.tree.link[i].parent;
      if (parent >= 0) add(parent, to_parent(w_, i, load_wrench(rows(i))));
    }
  }
  // Of a joint, about its anchor on B, which moves as the joints up to this one move it.
  Wrench at(const kernels::TreeAnchor<Real>& anchor) const {
    const Wrench f = load_wrench(rows(anchor.link));
    const FramePose pose = pose_after(anchor.link, anchor.joints);
    const Vec3 from_frame = pose.x - load_pose(w_, anchor.link).x;
    const Vec3 arm = from_frame + rotate(pose.q, shared(anchor.position));
    return {f.n - cross(arm, f.f), f.f};
  }

 private:
  Real* rows(int link) const { return link_rows(w_.tree.force, link, kTwistRows); }
  void add(int link, const Wrench& f) const { store(rows(link), load_wrench(rows(link)) + f); }

  // Those of the dofs, which add up along the tree as velocities do. Wrenches are not there yet.
  void add_accelerations() const {
    for (int i = 0; i < t_.tree.links; ++i) {
      const TreeLink& link = t_.tree.link[i];
      Twist a{zero_of<Vec3>(), zero_of<Vec3>()};
      if (link.parent >= 0) a = from_parent(w_, i, load_twist(rows(link.parent)));
      for (int k = link.first_dof; k < link.first_dof + link.dofs; ++k) {
        a = fma(load_twist(axis_of(w_, k)), Float::load(w_.tree.load + k * kLanes), a);
      }
      store(rows(i), a);
      Real* rate = link_rows(w_.tree.rate, i, kTwistRows);
      store(rate, load_twist(rate) + a);
    }
  }
  // Contacts push from outside.
  void take_contacts() const {
    for_each_contact_force(t_, w_, [&](const TreePair& pair, const TreeContact& c, Vec3 force) {
      const Vec3 arm_a = load_vec3(c.arm_a[0]), arm_b = load_vec3(c.arm_b[0]);
      add(pair.link_b, {cross(force, arm_b), -force});
      if (pair.link_a >= 0) add(pair.link_a, {cross(arm_a, force), force});
    });
  }
  // Of the frame that the first `joints` of a link's joints have moved, from the tree's origin.
  FramePose pose_after(int index, int joints) const {
    const TreeLink& link = t_.tree.link[index];
    if (joints == link.joints) return load_pose(w_, index);
    FramePose at{shared(link.rotation), shared(link.position)};
    if (link.parent >= 0) {
      const FramePose parent = load_pose(w_, link.parent);
      at = {mul(parent.q, at.q), parent.x + rotate(parent.q, at.x)};
    }
    alignas(64) Real axis[kTwistRows * kLanes];
    for (int j = link.first_joint; j < link.first_joint + joints; ++j) {
      const TreeJoint& joint = t_.tree.joint[j];
      at = move_by(joint, coordinate_of(t_, g_, joint.coordinate), at, axis);
    }
    if (link.parent < 0) at.x = at.x - load_vec3(w_.tree.origin + 3 * index * kLanes);
    return at;
  }

  const Constants& t_;
  const Group& g_;
  const Work& w_;
};

inline void observe_tree_loads(const Constants& t, const Group& g, kernels::Scratch* scratch,
                               const ObserverView& o) {
  Group before = g;
  before.state = o.before;
  const TreeLoads loads(t, before, work_of(scratch));
  loads.find();
  const Mask live = mask_from_bits(~frozen_lanes(g) & kAllLanes);
  for (int j = 0; j < items_of(o, Observer::joint_loads); ++j) {
    const Wrench f = loads.at(o.anchor[j]);
    Real* rows = rows_for(o, Observer::joint_loads) + j * rows_of(Observer::joint_loads) * kLanes;
    store(rows + row_of(Observed::joint_force) * kLanes, select(live, f.f, zero_of<Vec3>()));
    store(rows + row_of(Observed::joint_torque) * kLanes, select(live, f.n, zero_of<Vec3>()));
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
