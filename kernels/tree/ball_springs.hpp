// Springs of ball joints: torques about the axis of the joint's rotation, which is the same in the
// axes of both links.
#pragma once

#include "kernels/tree/axis_angle.hpp"
#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Adds to the generalised forces.
inline void add_ball_springs(const Constants& t, const Group& g, const Work& w) {
  for (int i = 0; i < t.tree.ball_springs; ++i) {
    const auto& spring = t.tree.ball_spring[i];
    const AxisAngle at = axis_angle(normalize(load_quat(coordinate_of(t, g, spring.coordinate))));
    const Float pull = -(Float(constants_of_dof(g, spring.dof).stiffness) * at.angle);
    Real* load = w.tree.load + spring.dof * kLanes;
    store(load, fma(at.axis, pull, load_vec3(load)));
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
