// Controls: numbers that a caller sets for each world, and that every step acts on until they are
// set anew. What a policy has in its hands: the targets of drives, thrust at a point of a body,
// torque.
#pragma once

#include <Eigen/Core>
#include <string>

#include "manyworlds/ids.hpp"

namespace manyworlds {

enum class ControlKind {
  target_position,  // of a joint's drive, m or rad
  target_speed,     // of a joint's drive, m/s or rad/s
  thrust,           // N, along `direction` at `point` of a body
  torque,           // N m, about `direction` of a body
};

struct Control {
  std::string name = {};
  ControlKind kind = ControlKind::target_speed;
  JointId joint = {};                               // with a drive; target_position, target_speed
  BodyId body = {};                                 // dynamic; thrust, torque
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  // m, body frame
  Eigen::Vector3d direction{1, 0, 0};  // body frame, need not be unit; a planar torque is about z
  // Range; what is set beyond it counts as its end.
  double low = -1, high = 1;
  double initial = 0;  // what a world has when it begins
};

}  // namespace manyworlds
