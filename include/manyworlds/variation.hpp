// Variations: which numbers of a scene may differ from world to world, and within which range. What
// is not declared here is one number for all worlds and costs nothing.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "manyworlds/ids.hpp"

namespace manyworlds {

// X(name, what has one, numbers of each, unit, meaning). In the order in which they are applied: a
// mass is of the body as its sizes and densities have made it.
#define MW_PARAMETERS(X)                                                                         \
  X(size, shape, 3, "m",                                                                         \
    "sphere, circle: radius; capsule: radius, half length; box: half extents; polygon: half "    \
    "extents of its bounding box about the shape frame's axes (it is stretched); others 0")      \
  X(density, shape, 1, "kg/m^3", "kg/m^2 in the plane")                                          \
  X(mass, body, 1, "kg", "of a dynamic body; its inertia grows in proportion")                   \
  X(friction, shape, 1, "1", "Coulomb coefficient")                                              \
  X(restitution, shape, 1, "1", "0 to 1")                                                        \
  X(gravity, world, 3, "m/s^2", "")                                                              \
  X(gravity_scale, body, 1, "1", "")                                                             \
  X(linear_drag, body, 1, "1/s", "")                                                             \
  X(angular_drag, body, 1, "1/s", "")                                                            \
  X(armature, joint, 1, "kg m^2 or kg", "of Solver::newton: JointDynamics::armature")            \
  X(damping, joint, 1, "N m s/rad or N s/m", "of Solver::newton: JointDynamics::damping")        \
  X(stiffness, joint, 1, "N m/rad or N/m", "of Solver::newton: JointDynamics::stiffness")        \
  X(rest, joint, 1, "rad or m", "of Solver::newton: JointDynamics::rest")                        \
  X(gain, control, 3, "", "of Solver::newton: Actuator::gain")                                   \
  X(bias, control, 3, "", "of Solver::newton: Actuator::bias")                                   \
  X(kp, control, 1, "", "of a position servo: its gain is (kp, 0, 0), its bias (0, -kp, -kv)")   \
  X(kv, control, 1, "",                                                                          \
    "of a position servo, or of a velocity servo: its gain is (kv, 0, 0), its bias (0, 0, -kv)") \
  X(limit_low, joint, 1, "rad or m",                                                             \
    "of joints on bodies, as the rest: Limit::low of a hinge, slider, distance or wheel")        \
  X(limit_high, joint, 1, "rad or m", "Limit::high")                                             \
  X(motor_speed, joint, 1, "rad/s or m/s",                                                       \
    "Drive::target_speed of a hinge, slider or wheel; a control of it goes first")               \
  X(motor_force, joint, 1, "N m or N", "Drive::max_force")                                       \
  X(drive_stiffness, joint, 1, "N m/rad or N/m", "of Drive::spring")                             \
  X(drive_damping, joint, 1, "N m s/rad or N s/m", "of Drive::spring")                           \
  X(break_force, joint, 1, "N", "Joint::break_force, of a joint that has one")                   \
  X(break_torque, joint, 1, "N m", "Joint::break_torque, of a joint that has one")               \
  X(anchor_a, joint, 3, "m", "Joint::frame_a.position, in the body frame of A, or the world")    \
  X(anchor_b, joint, 3, "m", "Joint::frame_b.position, in the body frame of B")                  \
  X(axes_a, joint, 3, "rad", "Joint::frame_a.rotation, as a rotation vector: axis times angle")  \
  X(axes_b, joint, 3, "rad", "Joint::frame_b.rotation, likewise")                                \
  X(initial_position, body, 3, "m",                                                              \
    "Body::position, read where a world begins; not of Solver::newton, as the next three")       \
  X(initial_rotation, body, 3, "rad", "Body::rotation, as a rotation vector")                    \
  X(initial_linear_velocity, body, 3, "m/s", "Body::linear_velocity")                            \
  X(initial_angular_velocity, body, 3, "rad/s", "Body::angular_velocity")                        \
  X(center_of_mass, body, 3, "m", "of a dynamic body, in its frame; its inertia is about it")    \
  X(inertia_scale, body, 1, "1", "of a dynamic body: times the inertia of its shapes and mass")  \
  X(wind, world, 3, "m/s", "Options::wind")                                                      \
  X(control_low, control, 1, "", "Control::low, of any kind: what is set is clamped to it")      \
  X(control_high, control, 1, "", "Control::high")

enum class Parameter {
#define MW_PARAMETER_ENUM(name, owner, numbers, unit, meaning) name,
  MW_PARAMETERS(MW_PARAMETER_ENUM)
#undef MW_PARAMETER_ENUM
};
inline constexpr int kParameterCount = 38;

struct ParameterInfo {
  enum Owner { world, body, shape, joint, control };
  const char* name;
  Owner owner;
  int numbers;
  const char* unit;
  const char* meaning;
};
const ParameterInfo& info(Parameter parameter);
const char* to_string(ParameterInfo::Owner owner);

// What a world gets when it begins, at every reset anew.
enum class Draw {
  none,         // keeps what it has: the scene's number, until Batch::write
  uniform,      // between low and high
  log_uniform,  // its logarithm is uniform; low > 0
};

struct Variation {
  Parameter parameter = Parameter::friction;
  BodyId body = {};    // none: every one that has the parameter
  ShapeId shape = {};  // one shape, which also says of which body; none: every shape
  JointId joint = {};  // none: every one that has the parameter
  ControlId control = {};
  // The range, inclusive, within which the number of every world must lie; [0] alone counts where
  // the parameter is one number.
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
  Draw draw = Draw::uniform;
  bool together = false;  // one draw for all that it is about, instead of one for each
};

// A parameter of one number, of all that have it.
inline Variation vary(Parameter parameter, double low, double high, Draw draw = Draw::uniform) {
  Variation v;
  v.parameter = parameter;
  v.low.x() = low, v.high.x() = high;
  v.draw = draw;
  return v;
}

}  // namespace manyworlds
