// Equality constraints between bodies as joints: connect is a ball joint, weld a fixed one. Bodies
// joined by an equality go on colliding with each other, as in MuJoCo, unless a contact exclude
// says otherwise.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// Appends the kinds of equality that have no counterpart.
void check_equalities(const Model& model, std::vector<std::string>& problems);

// Appends what joints do otherwise: softness, and the equalities that are left out.
void compare_equalities(const Model& model, std::vector<std::string>& warnings);

// Whether the contact exclude is between two free bodies that a joint holds together, and means all
// of their shapes: then the joint sees to it.
bool excludes_joined(const Model& model, int exclude);

// `scene_body`: of each of MuJoCo's free bodies. Precondition: check_equalities finds nothing, and
// the scene knows its length_unit. Caps the speed at which joints close that begin apart.
void add_joints(const Model& model, const std::vector<BodyId>& scene_body, Scene& scene);

}  // namespace manyworlds::mjcf
