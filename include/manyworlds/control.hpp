// Controls: values that a caller sets for each world. They stay in effect until the caller sets
// others. A policy acts through them: targets of drives, thrust at a point of a body, torque.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "manyworlds/ids.hpp"

namespace manyworlds {

enum class ControlKind {
  target_position,  // m or rad, target of a joint's drive
  target_speed,     // m/s or rad/s, target of a joint's drive
  thrust,           // N, along `direction` at `point` of a body
  torque,           // N m, about `direction` of a body
  joint_force,      // Solver::newton only: input of an actuator on a hinge or slider
};

// A force along a joint's coordinate x of speed v, N or N m. With the clamped control u, the length
// l = gear x and the speed s = gear v, it is
//   gear clamp((gain.x + gain.y l + gain.z s) u + bias.x + bias.y l + bias.z s, low, high)
// A motor has gain 1; a position servo gain kp and bias (0, -kp, -kv); a velocity servo gain kv and
// bias (0, 0, -kv).
struct Actuator {
  double gear = 1;
  Eigen::Vector3d gain{1, 0, 0}, bias{0, 0, 0};
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool operator==(const Actuator&) const = default;
};

struct Control {
  std::string name = {};
  ControlKind kind = ControlKind::target_speed;
  // A joint with a drive (target_position, target_speed), or a hinge or slider (joint_force).
  JointId joint = {};
  BodyId body = {};                                 // dynamic; thrust, torque
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, body frame
  Eigen::Vector3d direction{1, 0, 0};  // body frame, need not be unit; a planar torque is about z
  // Range, to which values are clamped. The range of a joint_force may be infinite.
  double low = -1, high = 1;
  double initial = 0;      // value at the start of a world
  Actuator actuator = {};  // joint_force only
};

}  // namespace manyworlds
