// Poses of links, and the twists of their dofs, from the joint coordinates. Twists and wrenches of
// a link are about the origin of its frame; from_parent and to_parent move them.
#pragma once

#include "kernels/lane/elementary.hpp"
#include "kernels/lane/spatial.hpp"
#include "kernels/work/constants.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using TreeLink = kernels::TreeLink<Real>;
using TreeJoint = kernels::TreeJoint<Real>;
using Dof = kernels::TreeDof;
using kernels::TreeJointKind;
using DofBits = std::uint64_t;

MW_INLINE Real* coordinate_of(const Constants& t, const Group& g, int coordinate) {
  return g.state + (t.tree.first_coordinate + coordinate) * kLanes;
}
inline constexpr int kDofRows = 2;
MW_INLINE Real* velocity_of(const Constants& t, const Group& g, int dof) {
  return g.state + (t.tree.first_dof + kDofRows * dof) * kLanes;
}
MW_INLINE Real* acceleration_of(const Constants& t, const Group& g, int dof) {
  return velocity_of(t, g, dof) + kLanes;
}
// visit(row of dof k) of [dof][lane] arrays.
template <class Visit>
MW_INLINE void for_each_dof(const Constants& t, Visit visit) {
  for (int k = 0; k < t.tree.dofs; ++k) visit(k * kLanes);
}
MW_INLINE Real* axis_of(const Work& w, int dof) { return w.tree.axis + dof * kTwistRows * kLanes; }

MW_INLINE Vec3 shared(const Real (&v)[3]) { return {v[0], v[1], v[2]}; }
MW_INLINE Quat shared(const Real (&q)[4]) { return {q[0], q[1], q[2], q[3]}; }
MW_INLINE Vec3 of_lanes(const LaneNumber (&v)[3]) { return {v[0], v[1], v[2]}; }
MW_INLINE Quat of_lanes(const LaneNumber (&q)[4]) { return {q[0], q[1], q[2], q[3]}; }

MW_INLINE Real* offset_of(const Work& w, int link) { return w.tree.offset + link * 3 * kLanes; }

// Of a link's frame, from the tree's origin.
struct FramePose {
  Quat q;
  Vec3 x;
};
MW_INLINE FramePose load_pose(const Work& w, int link) {
  const Real* p = w.tree.pose + link * 7 * kLanes;
  return {load_quat(p), load_vec3(p + 4 * kLanes)};
}
MW_INLINE void store_pose(const Work& w, int link, const FramePose& at) {
  Real* p = w.tree.pose + link * 7 * kLanes;
  store(p, at.q), store(p + 4 * kLanes, at.x);
}

// Of a link from or to its parent.
MW_INLINE Twist from_parent(const Work& w, int link, const Twist& a) {
  return moved(a, load_vec3(offset_of(w, link)));
}
MW_INLINE Wrench to_parent(const Work& w, int link, const Wrench& a) {
  return moved(a, -load_vec3(offset_of(w, link)));
}

// Moves a link by one of its joints. Leaves in the rows of the first dof its axis, and a point on
// it; of a free or ball joint the point alone.
MW_INLINE FramePose move_by(const TreeJoint& joint, const Real* c, FramePose at, Real* rows) {
  const Vec3 axis = rotate(at.q, shared(joint.axis));
  if (joint.kind == TreeJointKind::slide) {
    store(rows, axis);
    at.x = fma(axis, Float::load(c) - Float(joint.reference), at.x);
    return at;
  }
  if (joint.kind == TreeJointKind::free) {
    at = {normalize(load_quat(c + 3 * kLanes)), load_vec3(c)};
    store(rows + 3 * kLanes, at.x);
    return at;
  }
  const Real* anchor = joint.anchor;
  const bool off_origin = anchor[0] != 0 || anchor[1] != 0 || anchor[2] != 0;  // in few models
  const Vec3 point = off_origin ? at.x + rotate(at.q, shared(joint.anchor)) : at.x;
  Quat rotation;
  if (joint.kind == TreeJointKind::ball) {
    rotation = normalize(load_quat(c));
  } else {
    const SineAndCosine half =
        sine_and_cosine((Float::load(c) - Float(joint.reference)) * Float(Real(0.5)));
    const Vec3 v = shared(joint.axis) * half.sine;
    rotation = {half.cosine, v.x, v.y, v.z};
    store(rows, axis);
  }
  store(rows + 3 * kLanes, point);
  at.q = mul(at.q, rotation);
  if (off_origin) at.x = point - rotate(at.q, shared(joint.anchor));
  return at;
}

// Twists of unit velocities: about axes through `point`, from the link's frame.
MW_INLINE void put_rotations(Real* rows, const Mat3& axes, Vec3 point) {
  store(rows, Twist{axes.x, cross(point, axes.x)});
  store(rows + kTwistRows * kLanes, Twist{axes.y, cross(point, axes.y)});
  store(rows + 2 * kTwistRows * kLanes, Twist{axes.z, cross(point, axes.z)});
}
MW_INLINE void finish_axes(const TreeJoint& joint, const FramePose& at, Real* rows) {
  const Vec3 zero = zero_of<Vec3>(), first = load_vec3(rows);
  const Vec3 point = load_vec3(rows + 3 * kLanes) - at.x;
  switch (joint.kind) {
    case TreeJointKind::slide: store(rows, Twist{zero, first}); break;
    case TreeJointKind::hinge: store(rows, Twist{first, cross(point, first)}); break;
    case TreeJointKind::ball: put_rotations(rows, matrix(at.q), point); break;
    case TreeJointKind::free: {
      const Float one(Real(1)), none(Real(0));
      store(rows, Twist{zero, {one, none, none}});
      store(rows + kTwistRows * kLanes, Twist{zero, {none, one, none}});
      store(rows + 2 * kTwistRows * kLanes, Twist{zero, {none, none, one}});
      put_rotations(rows + 3 * kTwistRows * kLanes, matrix(at.q), point);
    }
  }
}

// A product of unit quaternions is off by its rounding alone: a step of Newton's method for
// 1 / |q| from 1 is as good as a root and a division.
MW_INLINE Quat unit_again(Quat q) {
  const Float square = fma(q.z, q.z, fma(q.y, q.y, fma(q.x, q.x, q.w * q.w)));
  const Float scale = fnma(Float(Real(0.5)), square, Float(Real(1.5)));
  return {q.w * scale, q.x * scale, q.y * scale, q.z * scale};
}

inline void find_poses(const Constants& t, const Group& g, const Work& w) {
  for (int i = 0; i < t.tree.links; ++i) {
    const TreeLink& link = t.tree.link[i];
    FramePose at{shared(link.rotation), shared(link.position)};  // from the parent's frame
    if (link.parent >= 0) {
      const Quat parent = load_pose(w, link.parent).q;
      at = {mul(parent, at.q), rotate(parent, at.x)};
    }
    const TreeJoint* joints = t.tree.joint + link.first_joint;
    for (int j = 0; j < link.joints; ++j) {
      at = move_by(joints[j], coordinate_of(t, g, joints[j].coordinate), at,
                   axis_of(w, joints[j].dof));
    }
    at.q = unit_again(at.q);
    for (int j = 0; j < link.joints; ++j) {
      finish_axes(joints[j], at, axis_of(w, joints[j].dof));
    }
    if (link.parent < 0) {
      const Vec3 center = rotate(at.q, of_lanes(constants_of_link(g, i).center));
      store(w.tree.origin + 3 * i * kLanes, at.x + center);
      at.x = -center;
    } else {
      store(offset_of(w, i), at.x);
      at.x = load_pose(w, link.parent).x + at.x;
    }
    store_pose(w, i, at);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
