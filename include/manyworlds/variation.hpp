// Variations: which numbers of a scene may differ from world to world, and within which range. What
// is not declared here is one number for all worlds and costs nothing.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "manyworlds/ids.hpp"

namespace manyworlds {

// X(name, what has one, numbers of each, unit, meaning). In the order in which they are applied: a
// mass is of the body as its sizes and densities have made it.
#define MW_PARAMETERS(X)                                                                          \
  X(size, shape, 3, "m",                                                                          \
    "sphere, circle: radius; capsule: radius, half length; box: half extents; polygon: half "     \
    "extents of its bounding box about the shape frame's axes (it is stretched); others 0")       \
  X(density, shape, 1, "kg/m^3", "kg/m^2 in the plane")                                           \
  X(shape_position, shape, 3, "m", "Shape::position, of a moving body, in its frame")             \
  X(shape_rotation, shape, 3, "rad", "Shape::rotation, as a rotation vector")                     \
  X(mass, body, 1, "kg", "of a dynamic body; its inertia grows in proportion")                    \
  X(friction, shape, 1, "1", "Coulomb coefficient")                                               \
  X(restitution, shape, 1, "1", "0 to 1")                                                         \
  X(gravity, world, 3, "m/s^2", "")                                                               \
  X(gravity_scale, body, 1, "1", "")                                                              \
  X(linear_drag, body, 1, "1/s", "")                                                              \
  X(angular_drag, body, 1, "1/s", "")                                                             \
  X(armature, joint, 1, "kg m^2 or kg", "of Solver::newton: JointDynamics::armature")             \
  X(damping, joint, 1, "N m s/rad or N s/m", "of Solver::newton: JointDynamics::damping")         \
  X(stiffness, joint, 1, "N m/rad or N/m", "of Solver::newton: JointDynamics::stiffness")         \
  X(rest, joint, 1, "rad or m", "of Solver::newton: JointDynamics::rest")                         \
  X(gain, control, 3, "", "of Solver::newton: Actuator::gain")                                    \
  X(bias, control, 3, "", "of Solver::newton: Actuator::bias")                                    \
  X(kp, control, 1, "", "of a position servo: its gain is (kp, 0, 0), its bias (0, -kp, -kv)")    \
  X(kv, control, 1, "",                                                                           \
    "of a position servo, or of a velocity servo: its gain is (kv, 0, 0), its bias (0, 0, -kv)")  \
  X(gear, control, 1, "", "of Solver::newton: Actuator::gear")                                    \
  X(force_low, control, 1, "N or N m", "of Solver::newton: Actuator::low, before the gear")       \
  X(force_high, control, 1, "N or N m", "of Solver::newton: Actuator::high")                      \
  X(limit_solref, joint, 2, "",                                                                   \
    "of Solver::newton: Compliance::time_constant and damping_ratio of a limit")                  \
  X(limit_solimp, joint, 3, "",                                                                   \
    "of Solver::newton: Compliance::min_impedance, max_impedance and width of a limit")           \
  X(contact_solref, shape, 2, "",                                                                 \
    "of Solver::newton: time_constant and damping_ratio of SoftContact::compliance")              \
  X(contact_solimp, shape, 3, "",                                                                 \
    "of Solver::newton: min_impedance, max_impedance and width of SoftContact::compliance")       \
  X(limit_low, joint, 1, "rad or m", "Limit::low of a hinge, slider, distance, wheel or twist")   \
  X(limit_high, joint, 1, "rad or m", "Limit::high, of all balls of Solver::newton, too")         \
  X(motor_speed, joint, 1, "rad/s or m/s",                                                        \
    "of joints on bodies, as the rest: Drive::target_speed of a hinge, slider or wheel; a "       \
    "control of it goes first")                                                                   \
  X(motor_force, joint, 1, "N m or N", "Drive::max_force")                                        \
  X(drive_stiffness, joint, 1, "N m/rad or N/m", "of Drive::spring")                              \
  X(drive_damping, joint, 1, "N m s/rad or N s/m", "of Drive::spring")                            \
  X(drive_frequency, joint, 1, "Hz", "of Drive::spring that is given by it")                      \
  X(drive_damping_ratio, joint, 1, "1", "of the same")                                            \
  X(motor_position, joint, 1, "rad or m",                                                         \
    "Drive::target_position, of a drive with a spring; a control of it goes first")               \
  X(limit_stiffness, joint, 1, "N m/rad or N/m", "of Limit::spring")                              \
  X(limit_damping, joint, 1, "N m s/rad or N s/m", "of Limit::spring")                            \
  X(limit_frequency, joint, 1, "Hz", "of Limit::spring that is given by it")                      \
  X(limit_damping_ratio, joint, 1, "1", "of the same")                                            \
  X(spring_stiffness, joint, 1, "N/m", "of the spring of a distance, wheel or target joint")      \
  X(spring_damping, joint, 1, "N s/m", "of the same")                                             \
  X(spring_frequency, joint, 1, "Hz", "of the same that is given by it")                          \
  X(spring_damping_ratio, joint, 1, "1", "of the same")                                           \
  X(length, joint, 1, "m", "of a distance joint or pulley that has one; of a spring, its rest")   \
  X(cone, joint, 1, "rad", "BallJoint::cone")                                                     \
  X(pulley_ratio, joint, 1, "1", "PulleyJoint::ratio")                                            \
  X(control_point, control, 3, "m", "Control::point of a thrust, in the body frame")              \
  X(control_direction, control, 3, "1", "Control::direction of a thrust or torque; not its size") \
  X(break_force, joint, 1, "N", "Joint::break_force, of a joint that has one")                    \
  X(break_torque, joint, 1, "N m", "Joint::break_torque, of a joint that has one")                \
  X(anchor_a, joint, 3, "m", "Joint::frame_a.position, in the body frame of A, or the world")     \
  X(anchor_b, joint, 3, "m", "Joint::frame_b.position, in the body frame of B")                   \
  X(axes_a, joint, 3, "rad", "Joint::frame_a.rotation, as a rotation vector: axis times angle")   \
  X(axes_b, joint, 3, "rad", "Joint::frame_b.rotation, likewise")                                 \
  X(initial_position, body, 3, "m",                                                               \
    "Body::position, read where a world begins; not of Solver::newton, as the next three")        \
  X(initial_rotation, body, 3, "rad", "Body::rotation, as a rotation vector")                     \
  X(initial_linear_velocity, body, 3, "m/s", "Body::linear_velocity")                             \
  X(initial_angular_velocity, body, 3, "rad/s", "Body::angular_velocity")                         \
  X(center_of_mass, body, 3, "m", "of a dynamic body, in its frame; its inertia is about it")     \
  X(inertia_scale, body, 1, "1", "of a dynamic body: times the inertia of its shapes and mass")   \
  X(wind, world, 3, "m/s", "Options::wind")                                                       \
  X(attractor_position, attractor, 3, "m", "Attractor::position, in the world")                   \
  X(attractor_strength, attractor, 1, "m^3/s^2", "Attractor::strength")                           \
  X(control_low, control, 1, "", "Control::low, of any kind: what is set is clamped to it")       \
  X(control_high, control, 1, "", "Control::high")

enum class Parameter {
#define MW_PARAMETER_ENUM(name, owner, numbers, unit, meaning) name,
  MW_PARAMETERS(MW_PARAMETER_ENUM)
#undef MW_PARAMETER_ENUM
};
inline constexpr int kParameterCount = 65;

struct ParameterInfo {
  enum Owner { world, body, shape, joint, control, attractor };
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
  int attractor = -1;  // in Scene::attractors; -1: every one
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
