// Materials of geoms: friction, and in articulated models how soft their contacts are.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// Appends the contacts of articulated models that are not simulated.
void check_materials(const Model& model, std::vector<std::string>& problems);

// Whether any geom that collides has friction.
bool any_friction(const Model& model);

// Of each geom, in MuJoCo's order.
std::vector<Material> materials(const Model& model);

}  // namespace manyworlds::mjcf
