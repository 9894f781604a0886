#pragma once

#include "tools/invariants/family.hpp"

namespace manyworlds::invariants {

std::vector<Family> joint_motor_families();  // joint_motors.cpp: limits, motors and drives

}  // namespace manyworlds::invariants
