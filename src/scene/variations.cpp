#include "src/scene/variations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <variant>

#include "src/base/enum_names.hpp"
#include "src/scene/rotation_vector.hpp"
#include "src/scene/scene_numbers.hpp"
#include "src/scene/shape/shape.hpp"

namespace manyworlds {

namespace {

int sizes_of(const Geometry& geometry) { return traits_of(geometry).sizes(); }

void set_mass(Scene& scene, Body& body, double mass) {
  MassProperties m = mass_properties(scene, body);
  m.inertia *= mass / m.mass;
  m.mass = mass;
  body.mass_properties = m;
}
MassProperties& given_mass(Scene& scene, Body& body) {
  if (!body.mass_properties) body.mass_properties = mass_properties(scene, body);
  return *body.mass_properties;
}

int numbers_of(const Scene& scene, Parameter parameter, const NumberOwner& of) {
  return parameter == Parameter::size ? sizes_of(shape_of(scene, of).geometry)
                                      : info(parameter).numbers;
}

// Servos are known by their numbers, which therefore stay above 0: gain (kp, 0, 0) and
// bias (0, -kp, -kv), or gain (kv, 0, 0) and bias (0, 0, -kv).
bool is_servo(const Actuator& a) {
  return a.gain.x() > 0 && a.gain.y() == 0 && a.gain.z() == 0 && a.bias.x() == 0;
}
bool is_position_servo(const Actuator& a) { return is_servo(a) && a.bias.y() == -a.gain.x(); }
bool is_velocity_servo(const Actuator& a) {
  return is_servo(a) && a.bias.y() == 0 && a.bias.z() == -a.gain.x();
}

bool joint_can(const JointType& type, Parameter parameter) {
  const bool single =
      std::holds_alternative<HingeJoint>(type) || std::holds_alternative<SliderJoint>(type);
  return single || (std::holds_alternative<BallJoint>(type) && parameter != Parameter::rest);
}
bool control_can(ControlKind kind, const Actuator& a, Parameter parameter) {
  if (kind != ControlKind::joint_force) return false;
  if (parameter == Parameter::kp) return is_position_servo(a);
  return parameter != Parameter::kv || is_position_servo(a) || is_velocity_servo(a);
}

bool is_about(const Variation& v, const NumberOwner& of) {
  const auto is = [](auto id, int index) { return !id || id.index() == index; };
  return is(body_of(v), of.body) && is(v.shape, of.shape) && is(v.joint, of.joint) &&
         is(v.control, of.control) && (v.attractor < 0 || v.attractor == of.attractor);
}

}  // namespace

bool is_of_bodies(Parameter parameter) {
  return parameter == Parameter::wind ||
         (parameter >= Parameter::motor_speed && parameter <= Parameter::initial_angular_velocity);
}
bool is_of_newton(Parameter parameter) {
  return parameter >= Parameter::armature && parameter <= Parameter::contact_solimp;
}

const ParameterInfo& info(Parameter parameter) {
  static constexpr std::array kInfo = {
#define MW_PARAMETER_INFO(name, owner, numbers, unit, meaning) \
  ParameterInfo{#name, ParameterInfo::owner, numbers, unit, meaning},
      MW_PARAMETERS(MW_PARAMETER_INFO)
#undef MW_PARAMETER_INFO
  };
  static_assert(kInfo.size() == kParameterCount);
  return kInfo[static_cast<std::size_t>(checked_enum(parameter))];
}

const char* to_string(ParameterInfo::Owner owner) {
  switch (owner) {
    case ParameterInfo::world: return "world";
    case ParameterInfo::body: return "body";
    case ParameterInfo::shape: return "shape";
    case ParameterInfo::joint: return "joint";
    case ParameterInfo::control: return "control";
    case ParameterInfo::attractor: return "attractor";
  }
  return "?";
}

std::vector<NumberOwner> owners_of(const Scene& scene, Parameter parameter) {
  std::vector<NumberOwner> out;
  const auto count = [](const auto& list) { return static_cast<int>(list.size()); };
  switch (info(parameter).owner) {
    case ParameterInfo::world: out.emplace_back(); break;
    case ParameterInfo::body:
      for (int b = 0; b < count(scene.bodies); ++b) {
        if (at(scene.bodies, b).motion != Motion::fixed) out.push_back({.body = b});
      }
      break;
    case ParameterInfo::shape:
      for (int b = 0; b < count(scene.bodies); ++b) {
        for (int s = 0; s < count(at(scene.bodies, b).shapes); ++s) {
          out.push_back({.body = b, .shape = s});
        }
      }
      break;
    case ParameterInfo::joint:
      for (int j = 0; j < count(scene.joints); ++j) out.push_back({.joint = j});
      break;
    case ParameterInfo::control:
      for (int c = 0; c < count(scene.controls); ++c) out.push_back({.control = c});
      break;
    case ParameterInfo::attractor:
      for (int a = 0; a < count(scene.attractors); ++a) out.push_back({.attractor = a});
      break;
  }
  return out;
}

bool can_vary(const Scene& scene, Parameter parameter, const NumberOwner& of) {
  switch (parameter) {
    case Parameter::gravity:
    case Parameter::wind:
    case Parameter::attractor_position:
    case Parameter::attractor_strength:
    case Parameter::control_low:
    case Parameter::control_high:
    case Parameter::friction:
    case Parameter::restitution:
    case Parameter::rolling_resistance:
    case Parameter::contact_solref:
    case Parameter::contact_solimp:
    case Parameter::anchor_a:
    case Parameter::anchor_b: return true;
    case Parameter::shape_position:
    case Parameter::shape_rotation:
    case Parameter::initial_position:
    case Parameter::initial_rotation:
    case Parameter::initial_linear_velocity:
    case Parameter::initial_angular_velocity: return body_of(scene, of).motion != Motion::fixed;
    case Parameter::torsional_resistance: return scene.space == Space::spatial;
    case Parameter::size:
      return body_of(scene, of).motion != Motion::fixed &&
             sizes_of(shape_of(scene, of).geometry) > 0;
    case Parameter::density:
      return body_of(scene, of).motion == Motion::dynamic && !body_of(scene, of).mass_properties;
    case Parameter::mass:
    case Parameter::center_of_mass:
    case Parameter::inertia_scale:
    case Parameter::gravity_scale:
    case Parameter::linear_drag:
    case Parameter::angular_drag: return body_of(scene, of).motion == Motion::dynamic;
    case Parameter::armature:
    case Parameter::damping:
    case Parameter::stiffness:
    case Parameter::rest: return joint_can(at(scene.joints, of.joint).type, parameter);
    case Parameter::gain:
    case Parameter::bias:
    case Parameter::kp:
    case Parameter::kv:
    case Parameter::gear:
    case Parameter::force_low:
    case Parameter::force_high: {
      const Control& control = at(scene.controls, of.control);
      return control_can(control.kind, control.actuator, parameter);
    }
    case Parameter::limit_solref:
    case Parameter::limit_solimp: return has_finite_limit(at(scene.joints, of.joint));
    case Parameter::limit_low:
    case Parameter::limit_high:
    case Parameter::motor_speed:
    case Parameter::motor_force:
    case Parameter::drive_stiffness:
    case Parameter::drive_damping:
    case Parameter::drive_frequency:
    case Parameter::drive_damping_ratio:
    case Parameter::motor_position:
    case Parameter::limit_stiffness:
    case Parameter::limit_damping:
    case Parameter::limit_frequency:
    case Parameter::limit_damping_ratio:
    case Parameter::spring_stiffness:
    case Parameter::spring_damping:
    case Parameter::spring_frequency:
    case Parameter::spring_damping_ratio:
    case Parameter::length:
    case Parameter::cone:
    case Parameter::pulley_ratio:
    case Parameter::break_force:
    case Parameter::break_torque: return joint_has(at(scene.joints, of.joint), parameter);
    case Parameter::control_point:
      return at(scene.controls, of.control).kind == ControlKind::thrust;
    case Parameter::control_direction: {
      const ControlKind kind = at(scene.controls, of.control).kind;  // planar torques are about z
      return kind == ControlKind::thrust ||
             (kind == ControlKind::torque && scene.space == Space::spatial);
    }
    case Parameter::axes_a:
    case Parameter::axes_b: return has_axes(at(scene.joints, of.joint).type);
  }
  return false;
}

std::vector<VariedNumber> varied_numbers(const Scene& scene) {
  std::vector<VariedNumber> out;
  for (std::size_t i = 0; i < scene.variations.size(); ++i) {
    const Variation& v = scene.variations[i];
    for (const NumberOwner& of : owners_of(scene, v.parameter)) {
      if (!is_about(v, of) || !can_vary(scene, v.parameter, of)) continue;
      for (int c = 0; c < numbers_of(scene, v.parameter, of); ++c) {
        out.push_back({static_cast<int>(i), v.parameter, of, c, v.low[c], v.high[c]});
      }
    }
  }
  std::stable_sort(out.begin(), out.end(), [](const VariedNumber& a, const VariedNumber& b) {
    return a.parameter < b.parameter;
  });
  return out;
}

double get_number(const Scene& scene, Parameter parameter, const NumberOwner& of, int component) {
  if (const Quat* rotation = quaternion_of(scene, parameter, of)) {
    return rotation_vector(*rotation)[component];
  }
  if (const double* number = held_number(scene, parameter, of, component)) return *number;
  switch (parameter) {
    case Parameter::size: {
      const Geometry& geometry = shape_of(scene, of).geometry;
      return component < sizes_of(geometry) ? traits_of(geometry).size(geometry, component) : 0;
    }
    case Parameter::density: return shape_of(scene, of).density.value_or(scene.options.density);
    case Parameter::mass:
      return body_of(scene, of).motion == Motion::dynamic
                 ? mass_properties(scene, body_of(scene, of)).mass
                 : 0;
    case Parameter::center_of_mass:
      return body_of(scene, of).motion == Motion::dynamic
                 ? mass_properties(scene, body_of(scene, of)).center[component]
                 : 0;
    case Parameter::inertia_scale: return body_of(scene, of).motion == Motion::dynamic ? 1 : 0;
    case Parameter::gain:
    case Parameter::bias:
    case Parameter::kp:
    case Parameter::kv:
    case Parameter::gear:
    case Parameter::force_low:
    case Parameter::force_high: {
      const Control& control = at(scene.controls, of.control);
      return get_number(control.kind, control.actuator, parameter, component);
    }
    default: return 0;
  }
}

double get_number(ControlKind kind, const Actuator& a, Parameter parameter, int component) {
  if (const double* number = actuator_number(a, parameter, component)) return *number;
  if (!control_can(kind, a, parameter)) return 0;
  return parameter == Parameter::kp ? a.gain.x() : 0 - a.bias.z();  // never -0
}

namespace {

void set_number(Scene& scene, const VariedNumber& n, double value) {
  if (double* number = held_number(scene, n.parameter, n.of, n.component)) {
    *number = value;
    return;
  }
  switch (n.parameter) {
    case Parameter::size: {
      Geometry& geometry = shape_of(scene, n.of).geometry;
      traits_of(geometry).resize(geometry, n.component, value);
      break;
    }
    case Parameter::density: shape_of(scene, n.of).density = value; break;
    case Parameter::mass: set_mass(scene, body_of(scene, n.of), value); break;
    case Parameter::center_of_mass:
      given_mass(scene, body_of(scene, n.of)).center[n.component] = value;
      break;
    case Parameter::inertia_scale: given_mass(scene, body_of(scene, n.of)).inertia *= value; break;
    default:  // of an actuator
      set_number(at(scene.controls, n.of.control).actuator, n.parameter, n.component, value);
  }
}

}  // namespace

void set_numbers(Scene& scene, const std::vector<VariedNumber>& numbers, const double* values) {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    // The three numbers of a rotation follow one another.
    if (Quat* rotation = quaternion_of(scene, numbers[i].parameter, numbers[i].of)) {
      *rotation = rotation_of(Vec3(values[i], values[i + 1], values[i + 2]));
      i += 2;
    } else {
      set_number(scene, numbers[i], values[i]);
    }
  }
}

void set_number(Actuator& a, Parameter parameter, int component, double value) {
  if (double* number = actuator_number(a, parameter, component)) {
    *number = value;
    return;
  }
  const bool position = parameter == Parameter::kp;
  if (position || is_velocity_servo(a)) a.gain.x() = value;
  a.bias[position ? 1 : 2] = 0 - value;  // never -0
}

}  // namespace manyworlds
