// The numbers of joints that can vary, where they are in the scene. Of a const joint the
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
    } else if constexpr (std::is_same_v<Of, BallJoint>) {  // the latter of Solver::newton
      return Pointer(of.twist ? &*of.twist : of.limit ? &*of.limit : nullptr);
    } else if constexpr (requires { of.limit->low; }) {
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

// Of the joint itself: a suspension, or what draws it to a length or target.
template <class Type>
auto* spring_of(Type& type) {
  const auto found = [](auto& of) {
    using Pointer = std::conditional_t<std::is_const_v<Type>, const Spring*, Spring*>;
    if constexpr (requires { of.suspension; }) {
      return Pointer(&of.suspension);
    } else if constexpr (requires { of.spring->stiffness; }) {
      return Pointer(of.spring ? &*of.spring : nullptr);
    } else if constexpr (requires { of.spring.stiffness; }) {
      return Pointer(&of.spring);
    } else {
      return Pointer(nullptr);
    }
  };
  return std::visit(found, type);
}

// Four parameters in a row, from `first` on; nullptr: the spring is given by the other two.
template <class S>
auto* spring_number(S& spring, Parameter first, Parameter parameter) {
  using Pointer = std::conditional_t<std::is_const_v<S>, const double*, double*>;
  const int which = static_cast<int>(parameter) - static_cast<int>(first);
  if (which < 0 || which > 3 || (spring.frequency > 0) != (which >= 2)) return Pointer(nullptr);
  Pointer const numbers[] = {&spring.stiffness, &spring.damping, &spring.frequency,
                             &spring.damping_ratio};
  return numbers[which];
}

// Numbers that joints of one type have, or of two.
template <class Joint>
auto* own_number(Joint& joint, Parameter parameter) {
  using Pointer = std::conditional_t<std::is_const_v<Joint>, const double*, double*>;
  const auto given = [](auto& number) { return Pointer(number ? &*number : nullptr); };
  auto& type = joint.type;
  if (auto* distance = std::get_if<DistanceJoint>(&type)) {
    const bool counts = parameter == Parameter::length && (distance->spring || !distance->limit);
    return counts ? given(distance->length) : Pointer(nullptr);
  }
  if (auto* ball = std::get_if<BallJoint>(&type); ball && parameter == Parameter::cone) {
    return given(ball->cone);
  }
  auto* pulley = std::get_if<PulleyJoint>(&type);
  if (pulley == nullptr) return Pointer(nullptr);
  if (parameter == Parameter::length) return given(pulley->length);
  return parameter == Parameter::pulley_ratio ? Pointer(&pulley->ratio) : Pointer(nullptr);
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
    const auto* ball = std::get_if<BallJoint>(&type);
    const bool one_sided = ball != nullptr && !ball->twist;  // an angle without a sign
    if (one_sided && parameter == Parameter::limit_low) return Pointer(nullptr);
    return Pointer(parameter == Parameter::limit_low ? &limit->low : &limit->high);
  }
  if (parameter >= Parameter::length && parameter <= Parameter::pulley_ratio) {
    return own_number(joint, parameter);
  }
  if (parameter >= Parameter::spring_stiffness && parameter <= Parameter::spring_damping_ratio) {
    auto* spring = spring_of(type);
    return spring ? spring_number(*spring, Parameter::spring_stiffness, parameter)
                  : Pointer(nullptr);
  }
  if (parameter >= Parameter::limit_stiffness && parameter <= Parameter::limit_damping_ratio) {
    auto* limit = limit_of(type);
    if (limit == nullptr || !limit->spring) return Pointer(nullptr);
    return spring_number(*limit->spring, Parameter::limit_stiffness, parameter);
  }
  auto* drive = drive_of(type);
  if (drive == nullptr) return Pointer(nullptr);
  if (parameter == Parameter::motor_speed) return Pointer(&drive->target_speed);
  if (parameter == Parameter::motor_force) return Pointer(&drive->max_force);
  if (!drive->spring) return Pointer(nullptr);
  if (parameter == Parameter::motor_position) return Pointer(&drive->target_position);
  return spring_number(*drive->spring, Parameter::drive_stiffness, parameter);
}

// Numbers of a compliance, as MuJoCo puts them together: solref or solimp.
inline bool is_solref(Parameter parameter) {
  return parameter == Parameter::contact_solref || parameter == Parameter::limit_solref;
}
template <class Of>
auto& compliance_number(Of& c, bool reference, int component) {
  if (reference) return component == 0 ? c.time_constant : c.damping_ratio;
  return component == 0 ? c.min_impedance : component == 1 ? c.max_impedance : c.width;
}

// What is infinite, or never acts, has no rows in the plan.
inline bool joint_has(const Joint& joint, Parameter parameter) {
  const double* number = number_of(joint, parameter);
  return number != nullptr && (std::isfinite(*number) || parameter == Parameter::motor_force);
}
inline bool has_finite_limit(const Joint& joint) {
  const Limit* limit = limit_of(joint.type);
  return limit != nullptr && (std::isfinite(limit->low) || std::isfinite(limit->high));
}
// Do the axes of its frames mean anything?
inline bool has_axes(const JointType& type) {
  if (const auto* ball = std::get_if<BallJoint>(&type)) return ball->cone || ball->twist;
  return !std::holds_alternative<DistanceJoint>(type) &&
         !std::holds_alternative<PulleyJoint>(type) && !std::holds_alternative<TargetJoint>(type);
}

}  // namespace manyworlds
