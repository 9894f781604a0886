// Coordinates after some motion, and whether they are in range.
#pragma once

#include "kernels/lane/elementary.hpp"
#include "kernels/motion/finish.hpp"
#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A rotation after the angular velocity w, in its own axes, for dt.
MW_INLINE Quat rotate_for(Quat q, Vec3 w, Float dt) {
  const Float speed2 = dot(w, w), speed = sqrt(speed2), half = Float(Real(0.5)) * dt;
  const SineAndCosine part = sine_and_cosine(speed * half);
  const Mask moves = Float(Real(0)) < speed;
  const Float scale = select(moves, part.sine / select(moves, speed, Real(1)), half);
  const Vec3 v = w * scale;
  return normalize(mul(q, {part.cosine, v.x, v.y, v.z}));
}

constexpr Real kMaxAcceleration = Real(1e18);  // m/s^2 or rad/s^2: its square is a float32

struct Next {
  Mask good = mask_from_bits(kAllLanes), finite = mask_from_bits(kAllLanes);
  template <class T>
  MW_INLINE void check(T value, Real limit) {
    const Mask ok = in_range(value, limit);
    good = good & ok;
    if (!all(ok)) finite = finite & is_finite(value);
  }
};

// visit(joint) of all.
template <class Visit>
MW_INLINE void for_each_joint(const Constants& t, Visit visit) {
  for (int i = 0; i < t.tree.links; ++i) {
    const TreeLink& link = t.tree.link[i];
    for (int j = link.first_joint; j < link.first_joint + link.joints; ++j) visit(t.tree.joint[j]);
  }
}

// From coordinates, with velocities [dof][lane] for dt.
MW_INLINE void integrate(const Constants& t, const Real* coordinates, const Real* velocities,
                         Float dt, Real* out, Next& next) {
  for_each_joint(t, [&](const TreeJoint& joint) {
    const Real* from = coordinates + joint.coordinate * kLanes;
    Real* to = out + joint.coordinate * kLanes;
    const Real* v = velocities + joint.dof * kLanes;
    if (joint.kind == TreeJointKind::free) {
      const Vec3 x = fma(load_vec3(v), dt, load_vec3(from));
      store(to, x);
      next.check(x, kMaxPosition);
      from += 3 * kLanes, to += 3 * kLanes, v += 3 * kLanes;
    }
    if (kernels::coordinates_of(joint.kind) > 1) {
      const Quat q = rotate_for(normalize(load_quat(from)), load_vec3(v), dt);
      store(to, q);
      next.check(q, kMaxOrientation);
    } else {
      const Float x = fma(Float::load(v), dt, Float::load(from));
      x.store(to);
      next.check(x, kMaxPosition);
    }
  });
}

// The state after a step, from w.tree.next (coordinates, then velocities) in these lanes.
inline void commit(const Constants& t, const Group& g, const Work& w, std::uint32_t lanes) {
  const Mask keep = mask_from_bits(lanes);
  const auto put = [&](const Real* from, Real* to) {
    select(keep, Float::load(from), Float::load(to)).store(to);
  };
  const Real* velocity = w.tree.next + t.tree.coordinates * kLanes;
  for (int c = 0; c < t.tree.coordinates; ++c) {
    put(w.tree.next + c * kLanes, coordinate_of(t, g, c));
  }
  for (int k = 0; k < t.tree.dofs; ++k) put(velocity + k * kLanes, velocity_of(t, g, k));
  const Real* acceleration = t.tree.has_rows ? w.tree.guess : w.tree.load;
  for (int k = 0; k < t.tree.dofs; ++k) put(acceleration + k * kLanes, acceleration_of(t, g, k));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
