// Actuators on hinges and slides, as controls with which Solver::newton acts on a joint.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// Appends the actuators of an articulated model that are not simulated.
void check_actuators(const Model& model, std::vector<std::string>& problems);

// `scene_joint`: of each of MuJoCo's. Precondition: check_actuators finds nothing.
void add_actuators(const Model& model, const std::vector<JointId>& scene_joint, Scene& scene);

}  // namespace manyworlds::mjcf
