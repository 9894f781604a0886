#include "src/scene/variations.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>
#include <variant>

#include "src/base/enum_names.hpp"
#include "src/scene/joint_numbers.hpp"
#include "src/scene/rotation_vector.hpp"
#include "src/scene/shape/shape.hpp"

namespace manyworlds {

namespace {

template <class List>
auto& at(List& list, int index) {
  return list[static_cast<std::size_t>(index)];
}
auto& body_of(auto& scene, const NumberOwner& of) { return at(scene.bodies, of.body); }
auto& shape_of(auto& scene, const NumberOwner& of) {
  return at(body_of(scene, of).shapes, of.shape);
}
auto& dynamics_of(auto& scene, const NumberOwner& of) {
  return at(scene.joints, of.joint).dynamics;
}

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

// Vectors and rotations that the scene holds as they are; nullptr: the parameter is none.
template <class Of>
auto* vector_of(Of& scene, Parameter parameter, const NumberOwner& of) {
  using Pointer = std::conditional_t<std::is_const_v<Of>, const Vec3*, Vec3*>;
  switch (parameter) {
    case Parameter::gravity: return Pointer(&scene.options.gravity);
    case Parameter::wind: return Pointer(&scene.options.wind);
    case Parameter::anchor_a: return Pointer(&at(scene.joints, of.joint).frame_a.position);
    case Parameter::anchor_b: return Pointer(&at(scene.joints, of.joint).frame_b.position);
    case Parameter::initial_position: return Pointer(&body_of(scene, of).position);
    case Parameter::initial_linear_velocity: return Pointer(&body_of(scene, of).linear_velocity);
    case Parameter::initial_angular_velocity: return Pointer(&body_of(scene, of).angular_velocity);
    default: return Pointer(nullptr);
  }
}
template <class Of>
auto* quaternion_of(Of& scene, Parameter parameter, const NumberOwner& of) {
  using Pointer = std::conditional_t<std::is_const_v<Of>, const Quat*, Quat*>;
  switch (parameter) {
    case Parameter::axes_a: return Pointer(&at(scene.joints, of.joint).frame_a.rotation);
    case Parameter::axes_b: return Pointer(&at(scene.joints, of.joint).frame_b.rotation);
    case Parameter::initial_rotation: return Pointer(&body_of(scene, of).rotation);
    default: return Pointer(nullptr);
  }
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
         is(v.control, of.control);
}

}  // namespace

bool is_of_bodies(Parameter parameter) {
  return parameter == Parameter::wind ||
         (parameter >= Parameter::limit_low && parameter <= Parameter::initial_angular_velocity);
}
bool is_of_newton(Parameter parameter) {
  return parameter >= Parameter::armature && parameter <= Parameter::kv;
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
  }
  return out;
}

bool can_vary(const Scene& scene, Parameter parameter, const NumberOwner& of) {
  switch (parameter) {
    case Parameter::gravity:
    case Parameter::wind:
    case Parameter::control_low:
    case Parameter::control_high:
    case Parameter::friction:
    case Parameter::restitution:
    case Parameter::anchor_a:
    case Parameter::anchor_b: return true;
    case Parameter::initial_position:
    case Parameter::initial_rotation:
    case Parameter::initial_linear_velocity:
    case Parameter::initial_angular_velocity: return body_of(scene, of).motion != Motion::fixed;
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
    case Parameter::kv: {
      const Control& control = at(scene.controls, of.control);
      return control_can(control.kind, control.actuator, parameter);
    }
    case Parameter::limit_low:
    case Parameter::limit_high:
    case Parameter::motor_speed:
    case Parameter::motor_force:
    case Parameter::drive_stiffness:
    case Parameter::drive_damping:
    case Parameter::break_force:
    case Parameter::break_torque: return joint_has(at(scene.joints, of.joint), parameter);
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
  if (const Vec3* vector = vector_of(scene, parameter, of)) return (*vector)[component];
  if (const Quat* rotation = quaternion_of(scene, parameter, of)) {
    return rotation_vector(*rotation)[component];
  }
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
    case Parameter::control_low: return at(scene.controls, of.control).low;
    case Parameter::control_high: return at(scene.controls, of.control).high;
    case Parameter::friction: return shape_of(scene, of).material.friction;
    case Parameter::restitution: return shape_of(scene, of).material.restitution;
    case Parameter::gravity_scale: return body_of(scene, of).gravity_scale;
    case Parameter::linear_drag: return body_of(scene, of).linear_drag;
    case Parameter::angular_drag: return body_of(scene, of).angular_drag;
    case Parameter::armature: return dynamics_of(scene, of).armature;
    case Parameter::damping: return dynamics_of(scene, of).damping;
    case Parameter::stiffness: return dynamics_of(scene, of).stiffness;
    case Parameter::rest: return dynamics_of(scene, of).rest;
    case Parameter::gain:
    case Parameter::bias:
    case Parameter::kp:
    case Parameter::kv: {
      const Control& control = at(scene.controls, of.control);
      return get_number(control.kind, control.actuator, parameter, component);
    }
    case Parameter::limit_low:
    case Parameter::limit_high:
    case Parameter::motor_speed:
    case Parameter::motor_force:
    case Parameter::drive_stiffness:
    case Parameter::drive_damping:
    case Parameter::break_force:
    case Parameter::break_torque: {
      const double* number = number_of(at(scene.joints, of.joint), parameter);
      return number != nullptr ? *number : 0;
    }
    default: return 0;
  }
}

double get_number(ControlKind kind, const Actuator& a, Parameter parameter, int component) {
  if (parameter == Parameter::gain) return a.gain[component];
  if (parameter == Parameter::bias) return a.bias[component];
  if (!control_can(kind, a, parameter)) return 0;
  return parameter == Parameter::kp ? a.gain.x() : 0 - a.bias.z();  // never -0
}

namespace {

void set_number(Scene& scene, const VariedNumber& n, double value) {
  if (Vec3* vector = vector_of(scene, n.parameter, n.of)) {
    (*vector)[n.component] = value;
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
    case Parameter::control_low: at(scene.controls, n.of.control).low = value; break;
    case Parameter::control_high: at(scene.controls, n.of.control).high = value; break;
    case Parameter::friction: shape_of(scene, n.of).material.friction = value; break;
    case Parameter::restitution: shape_of(scene, n.of).material.restitution = value; break;
    case Parameter::gravity_scale: body_of(scene, n.of).gravity_scale = value; break;
    case Parameter::linear_drag: body_of(scene, n.of).linear_drag = value; break;
    case Parameter::angular_drag: body_of(scene, n.of).angular_drag = value; break;
    case Parameter::armature: dynamics_of(scene, n.of).armature = value; break;
    case Parameter::damping: dynamics_of(scene, n.of).damping = value; break;
    case Parameter::stiffness: dynamics_of(scene, n.of).stiffness = value; break;
    case Parameter::rest: dynamics_of(scene, n.of).rest = value; break;
    case Parameter::gain:
    case Parameter::bias:
    case Parameter::kp:
    case Parameter::kv:
      set_number(at(scene.controls, n.of.control).actuator, n.parameter, n.component, value);
      break;
    case Parameter::limit_low:
    case Parameter::limit_high:
    case Parameter::motor_speed:
    case Parameter::motor_force:
    case Parameter::drive_stiffness:
    case Parameter::drive_damping:
    case Parameter::break_force:
    case Parameter::break_torque:
      *number_of(at(scene.joints, n.of.joint), n.parameter) = value;
      break;
    default: break;
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
  if (parameter == Parameter::gain) {
    a.gain[component] = value;
  } else if (parameter == Parameter::bias) {
    a.bias[component] = value;
  } else {
    const bool position = parameter == Parameter::kp;
    if (position || is_velocity_servo(a)) a.gain.x() = value;
    a.bias[position ? 1 : 2] = 0 - value;  // never -0
  }
}

}  // namespace manyworlds
