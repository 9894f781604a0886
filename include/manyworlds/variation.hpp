// Variations: the parameters of a scene that differ from world to world, each within a range. A
// parameter without a variation has one value for all worlds and costs nothing.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "manyworlds/ids.hpp"

namespace manyworlds {

// X(name, owner, values per owner, unit, meaning), in the order of their application: `mass`
// replaces the mass that sizes and densities give.
#define MW_PARAMETERS(X)                                                                          \
  X(size, shape, 3, "m",                                                                          \
    "sphere, circle: radius; capsule: radius, half length; box: half extents; polygon: half "     \
    "extents of its bounding box along the shape frame's axes, to which it is scaled; unused: 0") \
  X(density, shape, 1, "kg/m^3", "kg/m^2 in the plane")                                           \
  X(shape_position, shape, 3, "m", "Shape::position of a moving body, in the body frame")         \
  X(shape_rotation, shape, 3, "rad", "Shape::rotation, as a rotation vector")                     \
  X(mass, body, 1, "kg", "dynamic body; the inertia scales in proportion")                        \
  X(friction, shape, 1, "1", "Coulomb coefficient")                                               \
  X(restitution, shape, 1, "1", "0 to 1")                                                         \
  X(rolling_resistance, shape, 1, "m", "Material::rolling_resistance")                            \
  X(torsional_resistance, shape, 1, "m", "Material::torsional_resistance, spatial scenes only")   \
  X(gravity, world, 3, "m/s^2", "")                                                               \
  X(gravity_scale, body, 1, "1", "")                                                              \
  X(linear_drag, body, 1, "1/s", "")                                                              \
  X(angular_drag, body, 1, "1/s", "")                                                             \
  X(armature, joint, 1, "kg m^2 or kg", "Solver::newton only: JointDynamics::armature")           \
  X(damping, joint, 1, "N m s/rad or N s/m", "Solver::newton only: JointDynamics::damping")       \
  X(stiffness, joint, 1, "N m/rad or N/m", "Solver::newton only: JointDynamics::stiffness")       \
  X(rest, joint, 1, "rad or m", "Solver::newton only: JointDynamics::rest")                       \
  X(gain, control, 3, "", "Solver::newton only: Actuator::gain")                                  \
  X(bias, control, 3, "", "Solver::newton only: Actuator::bias")                                  \
  X(kp, control, 1, "", "position servo, which has gain (kp, 0, 0) and bias (0, -kp, -kv)")       \
  X(kv, control, 1, "",                                                                           \
    "position servo, or velocity servo, which has gain (kv, 0, 0) and bias (0, 0, -kv)")          \
  X(gear, control, 1, "", "Solver::newton only: Actuator::gear")                                  \
  X(force_low, control, 1, "N or N m", "Solver::newton only: Actuator::low, before the gear")     \
  X(force_high, control, 1, "N or N m", "Solver::newton only: Actuator::high")                    \
  X(limit_solref, joint, 2, "",                                                                   \
    "Solver::newton only: Compliance::time_constant and damping_ratio of a limit")                \
  X(limit_solimp, joint, 3, "",                                                                   \
    "Solver::newton only: Compliance::min_impedance, max_impedance and width of a limit")         \
  X(contact_solref, shape, 2, "",                                                                 \
    "Solver::newton only: time_constant and damping_ratio of SoftContact::compliance")            \
  X(contact_solimp, shape, 3, "",                                                                 \
    "Solver::newton only: min_impedance, max_impedance and width of SoftContact::compliance")     \
  X(limit_low, joint, 1, "rad or m", "Limit::low of a hinge, slider, distance, wheel or twist")   \
  X(limit_high, joint, 1, "rad or m", "Limit::high; with Solver::newton also of ball joints")     \
  X(motor_speed, joint, 1, "rad/s or m/s",                                                        \
    "Drive::target_speed of a hinge, slider or wheel; a control of it has precedence. Not with "  \
    "Solver::newton, like the other parameters of motors, drives, springs and frames")            \
  X(motor_force, joint, 1, "N m or N", "Drive::max_force")                                        \
  X(drive_stiffness, joint, 1, "N m/rad or N/m", "Drive::spring, set by stiffness and damping")   \
  X(drive_damping, joint, 1, "N m s/rad or N s/m", "Drive::spring, set by stiffness and damping") \
  X(drive_frequency, joint, 1, "Hz", "Drive::spring, set by a frequency")                         \
  X(drive_damping_ratio, joint, 1, "1", "Drive::spring, set by a frequency")                      \
  X(motor_position, joint, 1, "rad or m",                                                         \
    "Drive::target_position of a drive with a spring; a control of it has precedence")            \
  X(limit_stiffness, joint, 1, "N m/rad or N/m", "Limit::spring, set by stiffness and damping")   \
  X(limit_damping, joint, 1, "N m s/rad or N s/m", "Limit::spring, set by stiffness and damping") \
  X(limit_frequency, joint, 1, "Hz", "Limit::spring, set by a frequency")                         \
  X(limit_damping_ratio, joint, 1, "1", "Limit::spring, set by a frequency")                      \
  X(spring_stiffness, joint, 1, "N/m",                                                            \
    "spring of a distance, wheel or target joint, set by stiffness")                              \
  X(spring_damping, joint, 1, "N s/m", "the same spring")                                         \
  X(spring_frequency, joint, 1, "Hz",                                                             \
    "spring of a distance, wheel or target joint, set by a frequency")                            \
  X(spring_damping_ratio, joint, 1, "1", "the same spring")                                       \
  X(length, joint, 1, "m", "distance joint or pulley with a length; rest length of a spring")     \
  X(cone, joint, 1, "rad", "BallJoint::cone")                                                     \
  X(pulley_ratio, joint, 1, "1", "PulleyJoint::ratio")                                            \
  X(control_point, control, 3, "m", "Control::point of a thrust, in the body frame")              \
  X(control_direction, control, 3, "1",                                                           \
    "Control::direction of a thrust or torque; its length has no effect")                         \
  X(break_force, joint, 1, "N", "Joint::break_force of a joint with a finite one")                \
  X(break_torque, joint, 1, "N m", "Joint::break_torque of a joint with a finite one")            \
  X(anchor_a, joint, 3, "m", "Joint::frame_a.position, in the body frame of A, or the world")     \
  X(anchor_b, joint, 3, "m", "Joint::frame_b.position, in the body frame of B")                   \
  X(axes_a, joint, 3, "rad", "Joint::frame_a.rotation, as a rotation vector: axis times angle")   \
  X(axes_b, joint, 3, "rad", "Joint::frame_b.rotation, as a rotation vector")                     \
  X(initial_position, body, 3, "m",                                                               \
    "Body::position at a reset; not with Solver::newton, like the next three")                    \
  X(initial_rotation, body, 3, "rad", "Body::rotation, as a rotation vector")                     \
  X(initial_linear_velocity, body, 3, "m/s", "Body::linear_velocity")                             \
  X(initial_angular_velocity, body, 3, "rad/s", "Body::angular_velocity")                         \
  X(center_of_mass, body, 3, "m", "dynamic body, in the body frame; the inertia is about it")     \
  X(inertia_scale, body, 1, "1", "dynamic body: factor of the inertia from its shapes and mass")  \
  X(wind, world, 3, "m/s", "Options::wind")                                                       \
  X(attractor_position, attractor, 3, "m", "Attractor::position, in the world")                   \
  X(attractor_strength, attractor, 1, "m^3/s^2", "Attractor::strength")                           \
  X(control_low, control, 1, "", "Control::low, to which values are clamped")                     \
  X(control_high, control, 1, "", "Control::high, to which values are clamped")

enum class Parameter {
#define MW_PARAMETER_ENUM(name, owner, numbers, unit, meaning) name,
  MW_PARAMETERS(MW_PARAMETER_ENUM)
#undef MW_PARAMETER_ENUM
};
inline constexpr int kParameterCount = 67;

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

// The value that a world gets at its start and at every reset.
enum class Draw {
  none,         // keeps its value: the scene's, or that of Batch::write
  uniform,      // between low and high
  log_uniform,  // the logarithm is uniform; low > 0
};

struct Variation {
  Parameter parameter = Parameter::friction;
  BodyId body = {};    // none: every body with the parameter
  ShapeId shape = {};  // a shape of any body; none: every shape
  JointId joint = {};  // none: every joint with the parameter
  ControlId control = {};
  int attractor = -1;  // in Scene::attractors; -1: every attractor
  // Inclusive range of the values of all worlds. A parameter of one value uses [0] only.
  Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
  Draw draw = Draw::uniform;
  bool together = false;  // one draw for all owners instead of one for each
};

// A variation of a parameter with one value, for all owners that have it.
inline Variation vary(Parameter parameter, double low, double high, Draw draw = Draw::uniform) {
  Variation v;
  v.parameter = parameter;
  v.low.x() = low, v.high.x() = high;
  v.draw = draw;
  return v;
}

}  // namespace manyworlds
