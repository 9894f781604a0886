// The numbers of joints on bodies that can vary, where they are in the scene. Of a const joint the
// pointers are to const; nullptr: the joint has no such number.
#pragma once

#include <cmath>
#include <type_traits>
#include <variant>

#include "manyworlds/joint.hpp"
#include "manyworlds/variation.hpp"

namespace manyworlds {

template <class Type>
auto* limit_of(Type& type) {
  const auto found = [](auto& of) {
    using Of = std::remove_cvref_t<decltype(of)>;
    using Pointer = std::conditional_t<std::is_const_v<Type>, const Limit*, Limit*>;
    if constexpr (std::is_same_v<Of, WheelJoint>) {
      return Pointer(of.travel ? &*of.travel : nullptr);
    } else if constexpr (requires { of.limit->low; } && !std::is_same_v<Of, BallJoint>) {
      return Pointer(of.limit ? &*of.limit : nullptr);
    } else {
      return Pointer(nullptr);
    }
  };
  return std::visit(found, type);
}
template <class Type>
auto* drive_of(Type& type) {
  const auto found = [](auto& of) {
    using Pointer = std::conditional_t<std::is_const_v<Type>, const Drive*, Drive*>;
    if constexpr (requires { of.drive->max_force; }) {
      return Pointer(of.drive ? &*of.drive : nullptr);
    } else {
      return Pointer(nullptr);
    }
  };
  return std::visit(found, type);
}

template <class Joint>
auto* number_of(Joint& joint, Parameter parameter) {
  auto& type = joint.type;
  using Pointer = std::conditional_t<std::is_const_v<Joint>, const double*, double*>;
  if (parameter == Parameter::break_force) return Pointer(&joint.break_force);
  if (parameter == Parameter::break_torque) return Pointer(&joint.break_torque);
  if (parameter == Parameter::limit_low || parameter == Parameter::limit_high) {
    auto* limit = limit_of(type);
    if (limit == nullptr) return Pointer(nullptr);
    return Pointer(parameter == Parameter::limit_low ? &limit->low : &limit->high);
  }
  auto* drive = drive_of(type);
  if (drive == nullptr) return Pointer(nullptr);
  if (parameter == Parameter::motor_speed) return Pointer(&drive->target_speed);
  if (parameter == Parameter::motor_force) return Pointer(&drive->max_force);
  const bool by_force = drive->spring && drive->spring->frequency == 0;
  if (!by_force) return Pointer(nullptr);
  return Pointer(parameter == Parameter::drive_stiffness ? &drive->spring->stiffness
                                                         : &drive->spring->damping);
}

// What is infinite, or never acts, has no rows in the plan.
inline bool joint_has(const Joint& joint, Parameter parameter) {
  const double* number = number_of(joint, parameter);
  return number != nullptr && (std::isfinite(*number) || parameter == Parameter::motor_force);
}
// Do the axes of its frames mean anything?
inline bool has_axes(const JointType& type) {
  if (const auto* ball = std::get_if<BallJoint>(&type)) return ball->cone || ball->twist;
  return !std::holds_alternative<DistanceJoint>(type) &&
         !std::holds_alternative<PulleyJoint>(type) && !std::holds_alternative<TargetJoint>(type);
}

}  // namespace manyworlds
