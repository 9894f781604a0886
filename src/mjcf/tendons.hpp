// Fixed tendons, as tendons of Solver::newton: those without limits are there to be looked at.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// Appends the tendons that do what is not simulated.
void check_tendons(const Model& model, std::vector<std::string>& problems);

// `scene_joint`: of each of MuJoCo's. Precondition: check_tendons finds nothing.
void add_tendons(const Model& model, const std::vector<JointId>& scene_joint, Scene& scene);

}  // namespace manyworlds::mjcf
