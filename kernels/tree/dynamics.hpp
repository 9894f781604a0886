// Forces and inertias of trees: composite rigid bodies for the joint-space inertia, recursive
// Newton-Euler for the forces that velocities and gravity ask for (Featherstone 2008, 5.3, 6.2).
#pragma once

#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

MW_INLINE Real* link_rows(Real* rows, int link, int count) { return rows + link * count * kLanes; }

// Velocities of links, and the accelerations that they would have without any of the dofs.
inline void find_velocities(const Constants& t, const Group& g, const Work& w) {
  for (int i = 0; i < t.tree.links; ++i) {
    const TreeLink& link = t.tree.link[i];
    Twist v{zero_of<Vec3>(), zero_of<Vec3>()}, rate = v;
    if (link.parent >= 0) {
      v = from_parent(w, i, load_twist(link_rows(w.tree.velocity, link.parent, kTwistRows)));
      rate = from_parent(w, i, load_twist(link_rows(w.tree.rate, link.parent, kTwistRows)));
    }
    const auto gain = [&](int first, int count) {
      Twist own{zero_of<Vec3>(), zero_of<Vec3>()};
      for (int k = first; k < first + count; ++k) {
        own = fma(load_twist(axis_of(w, k)), Float::load(velocity_of(t, g, k)), own);
      }
      return own;
    };
    for (int j = link.first_joint; j < link.first_joint + link.joints; ++j) {
      const TreeJoint& joint = t.tree.joint[j];
      int first = joint.dof, count = kernels::dofs_of(joint.kind);
      if (joint.kind == TreeJointKind::free) {  // its first axes are the world's
        v = v + gain(first, 3);
        first += 3, count -= 3;
      }
      const Twist own = gain(first, count);
      rate = rate + cross(v, own);
      v = v + own;
    }
    store(link_rows(w.tree.velocity, i, kTwistRows), v);
    store(link_rows(w.tree.rate, i, kTwistRows), rate);
  }
}

// What a medium at rest, or in the wind, does to a link: of the inertia box about its centre of
// mass (MuJoCo, "Fluid forces", inertia model).
MW_INLINE Wrench drag_of(const Constants& t, const kernels::DragConstants<LaneNumber>& drag,
                         const Mat3& axes, Vec3 velocity, Vec3 spin) {
  const Vec3 flow = velocity - shared(t.tree.wind);
  const auto along = [&](Vec3 v, Float viscous, const LaneNumber(&square)[3]) {
    const Vec3 own = mul_transposed(axes, v);
    const auto resist = [&](Float x, Float k) { return fma(k, abs(x), viscous) * x; };
    return -mul(axes,
                {resist(own.x, square[0]), resist(own.y, square[1]), resist(own.z, square[2])});
  };
  return {along(spin, drag.spin_viscous, drag.spin), along(flow, drag.viscous, drag.speed)};
}

// The inertia of each link by itself, and the wrench that its motion asks for, less those that act
// on it: gravity and the inputs.
inline void find_wrenches(const Constants& t, const Group& g, const Work& w) {
  for (int i = 0; i < t.tree.links; ++i) {
    const TreeLink& link = t.tree.link[i];
    const auto& body = constants_of_body(g, link.body);
    const auto& frame = constants_of_link(g, i);
    const Quat q = load_pose(w, i).q;
    const Vec3 c = rotate(q, of_lanes(frame.center));
    const Mat3 axes = matrix(mul(q, of_lanes(frame.principal)));
    const Sym3 moments = rotate_diagonal(axes, {body.inertia[0], body.inertia[1], body.inertia[2]});
    const SpatialInertia inertia = spatial_inertia(body.mass, c, moments);
    const Twist v = load_twist(link_rows(w.tree.velocity, i, kTwistRows));
    const Twist rate = load_twist(link_rows(w.tree.rate, i, kTwistRows));
    Wrench f = mul(inertia, rate) + cross(v, mul(inertia, v));
    Vec3 pull = Vec3{body.gravity[0], body.gravity[1], body.gravity[2]} * Float(body.mass);
    Vec3 moment = zero_of<Vec3>();
    if (g.force) {
      const Real* input = g.force + link.body * 6 * kLanes;
      pull = pull + load_vec3(input);
      moment = load_vec3(input + 3 * kLanes);
    }
    if (t.tree.has_medium) {
      const Wrench drag = drag_of(t, constants_of_drag(g, i), axes, v.v + cross(v.w, c), v.w);
      moment = moment + drag.n, pull = pull + drag.f;
    }
    f = f - Wrench{moment + cross(c, pull), pull};
    store(link_rows(w.tree.inertia, i, kInertiaRows), inertia);
    store(link_rows(w.tree.force, i, kTwistRows), f);
  }
}

// Generalised forces of springs and dampers.
MW_INLINE Float passive_force(const Constants& t, const Group& g, int k) {
  const Dof& dof = t.tree.dof[k];
  const auto& own = constants_of_dof(g, k);
  Float force = -(Float(own.damping) * Float::load(velocity_of(t, g, k)));
  if (dof.sprung) {
    const Float stretch = Float::load(coordinate_of(t, g, dof.coordinate)) - Float(own.rest);
    force = fnma(Float(own.stiffness), stretch, force);
  }
  return force;
}

using kernels::TreeActuator;

// The force that an actuator asks for, before its range.
MW_INLINE Float force_asked(const Constants& t, const Group& g, int actuator) {
  const TreeActuator& a = t.tree.actuator[actuator];
  const auto& own = constants_of_actuator(g, actuator);
  const Float gear(own.gear), length = gear * Float::load(coordinate_of(t, g, a.coordinate));
  const Float speed = gear * Float::load(velocity_of(t, g, a.dof));
  const auto affine = [&](const LaneNumber(&c)[3]) {
    return fma(Float(c[2]), speed, fma(Float(c[1]), length, Float(c[0])));
  };
  return fma(affine(own.gain), Float::load(g.control + a.control * kLanes), affine(own.bias));
}

// Adds the forces of actuators.
inline void add_actuators(const Constants& t, const Group& g, const Work& w) {
  for (int i = 0; i < t.tree.actuators; ++i) {
    const TreeActuator& a = t.tree.actuator[i];
    const auto& own = constants_of_actuator(g, i);
    const Float force = clamp(force_asked(t, g, i), Float(own.low), Float(own.high));
    Real* load = w.tree.load + a.dof * kLanes;
    fma(Float(own.gear), force, Float::load(load)).store(load);
  }
}

// Generalised forces, from the tips to the roots.
inline void project_wrenches(const Constants& t, const Group& g, const Work& w) {
  for (int i = t.tree.links - 1; i >= 0; --i) {
    const TreeLink& link = t.tree.link[i];
    const Wrench wrench = load_wrench(link_rows(w.tree.force, i, kTwistRows));
    for (int k = link.first_dof; k < link.first_dof + link.dofs; ++k) {
      const Float passive = passive_force(t, g, k);
      (passive - dot(load_twist(axis_of(w, k)), wrench)).store(w.tree.load + k * kLanes);
    }
    if (link.parent < 0) continue;
    Real* below = link_rows(w.tree.force, link.parent, kTwistRows);
    store(below, load_wrench(below) + to_parent(w, i, wrench));
  }
}

// The rows of the joint-space inertia, from composite rigid bodies.
inline void find_matrix(const Constants& t, const Group& g, const Work& w) {
  for (int i = t.tree.links - 1; i >= 0; --i) {
    const TreeLink& link = t.tree.link[i];
    const SpatialInertia inertia = load_inertia(link_rows(w.tree.inertia, i, kInertiaRows));
    for (int k = link.first_dof; k < link.first_dof + link.dofs; ++k) {
      const Dof& dof = t.tree.dof[k];
      const Twist axis = load_twist(axis_of(w, k));
      Wrench f = mul(inertia, axis);
      Real* row = w.tree.matrix + dof.entry * kLanes;
      (dot(axis, f) + Float(constants_of_dof(g, k).armature)).store(row);
      int at = i;
      for (int j = dof.parent; j >= 0; j = t.tree.dof[j].parent) {
        for (; at != t.tree.dof[j].link; at = t.tree.link[at].parent) f = to_parent(w, at, f);
        row += kLanes;
        dot(load_twist(axis_of(w, j)), f).store(row);
      }
    }
    if (link.parent < 0) continue;
    Real* beyond = link_rows(w.tree.inertia, link.parent, kInertiaRows);
    store(beyond, load_inertia(beyond) + moved(inertia, -load_vec3(offset_of(w, i))));
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
