// Numbers that vary and that the scene holds as they are, where they are in it. Of a const scene
// the pointers are to const; nullptr: the parameter is worked out from others, or its owner lacks
// it.
#pragma once

#include <cstddef>
#include <type_traits>

#include "src/scene/joint_numbers.hpp"
#include "src/scene/variations.hpp"

namespace manyworlds {

template <class List>
auto& at(List& list, int index) {
  return list[static_cast<std::size_t>(index)];
}
auto& body_of(auto& scene, const NumberOwner& of) { return at(scene.bodies, of.body); }
auto& shape_of(auto& scene, const NumberOwner& of) {
  return at(body_of(scene, of).shapes, of.shape);
}

template <class Of>
auto* vector_of(Of& scene, Parameter parameter, const NumberOwner& of) {
  using Pointer = std::conditional_t<std::is_const_v<Of>, const Vec3*, Vec3*>;
  switch (parameter) {
    case Parameter::gravity: return Pointer(&scene.options.gravity);
    case Parameter::wind: return Pointer(&scene.options.wind);
    case Parameter::anchor_a: return Pointer(&at(scene.joints, of.joint).frame_a.position);
    case Parameter::anchor_b: return Pointer(&at(scene.joints, of.joint).frame_b.position);
    case Parameter::attractor_position:
      return Pointer(&at(scene.attractors, of.attractor).position);
    case Parameter::shape_position: return Pointer(&shape_of(scene, of).position);
    case Parameter::control_point: return Pointer(&at(scene.controls, of.control).point);
    case Parameter::control_direction: return Pointer(&at(scene.controls, of.control).direction);
    case Parameter::initial_position: return Pointer(&body_of(scene, of).position);
    case Parameter::initial_linear_velocity: return Pointer(&body_of(scene, of).linear_velocity);
    case Parameter::initial_angular_velocity: return Pointer(&body_of(scene, of).angular_velocity);
    default: return Pointer(nullptr);
  }
}
// Its three numbers are a rotation vector.
template <class Of>
auto* quaternion_of(Of& scene, Parameter parameter, const NumberOwner& of) {
  using Pointer = std::conditional_t<std::is_const_v<Of>, const Quat*, Quat*>;
  switch (parameter) {
    case Parameter::axes_a: return Pointer(&at(scene.joints, of.joint).frame_a.rotation);
    case Parameter::axes_b: return Pointer(&at(scene.joints, of.joint).frame_b.rotation);
    case Parameter::initial_rotation: return Pointer(&body_of(scene, of).rotation);
    case Parameter::shape_rotation: return Pointer(&shape_of(scene, of).rotation);
    default: return Pointer(nullptr);
  }
}

// How soft something is.
template <class Of>
auto* compliance_of(Of& scene, Parameter parameter, const NumberOwner& of) {
  using Pointer = std::conditional_t<std::is_const_v<Of>, const Compliance*, Compliance*>;
  if (parameter == Parameter::contact_solref || parameter == Parameter::contact_solimp) {
    return Pointer(&shape_of(scene, of).material.soft.compliance);
  }
  if (parameter != Parameter::limit_solref && parameter != Parameter::limit_solimp) {
    return Pointer(nullptr);
  }
  auto* limit = limit_of(at(scene.joints, of.joint).type);
  return limit == nullptr ? Pointer(nullptr) : Pointer(&limit->compliance);
}

// Of an actuator; nullptr: a number that is several of its own.
template <class Of>
auto* actuator_number(Of& a, Parameter parameter, int component) {
  using Pointer = std::conditional_t<std::is_const_v<Of>, const double*, double*>;
  switch (parameter) {
    case Parameter::gain: return Pointer(&a.gain[component]);
    case Parameter::bias: return Pointer(&a.bias[component]);
    case Parameter::gear: return Pointer(&a.gear);
    case Parameter::force_low: return Pointer(&a.low);
    case Parameter::force_high: return Pointer(&a.high);
    default: return Pointer(nullptr);
  }
}

template <class Of>
auto* held_number(Of& scene, Parameter parameter, const NumberOwner& of, int component) {
  using Pointer = std::conditional_t<std::is_const_v<Of>, const double*, double*>;
  if (auto* vector = vector_of(scene, parameter, of)) return Pointer(&(*vector)[component]);
  if (auto* compliance = compliance_of(scene, parameter, of)) {
    const bool has = component < info(parameter).numbers;
    return has ? Pointer(&compliance_number(*compliance, is_solref(parameter), component))
               : Pointer(nullptr);
  }
  switch (parameter) {
    case Parameter::friction: return Pointer(&shape_of(scene, of).material.friction);
    case Parameter::restitution: return Pointer(&shape_of(scene, of).material.restitution);
    case Parameter::rolling_resistance:
      return Pointer(&shape_of(scene, of).material.rolling_resistance);
    case Parameter::torsional_resistance:
      return Pointer(&shape_of(scene, of).material.torsional_resistance);
    case Parameter::gravity_scale: return Pointer(&body_of(scene, of).gravity_scale);
    case Parameter::linear_drag: return Pointer(&body_of(scene, of).linear_drag);
    case Parameter::angular_drag: return Pointer(&body_of(scene, of).angular_drag);
    case Parameter::armature: return Pointer(&at(scene.joints, of.joint).dynamics.armature);
    case Parameter::damping: return Pointer(&at(scene.joints, of.joint).dynamics.damping);
    case Parameter::stiffness: return Pointer(&at(scene.joints, of.joint).dynamics.stiffness);
    case Parameter::rest: return Pointer(&at(scene.joints, of.joint).dynamics.rest);
    case Parameter::attractor_strength:
      return Pointer(&at(scene.attractors, of.attractor).strength);
    case Parameter::control_low: return Pointer(&at(scene.controls, of.control).low);
    case Parameter::control_high: return Pointer(&at(scene.controls, of.control).high);
    default:
      return of.joint < 0 ? Pointer(nullptr) : number_of(at(scene.joints, of.joint), parameter);
  }
}

}  // namespace manyworlds
