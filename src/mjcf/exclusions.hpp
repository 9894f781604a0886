// Which bodies of an articulated model do not collide with each other. MuJoCo leaves out pairs
//   of one weld: bodies without joints between them,
//   of a weld and the one that it is joined to, unless that is static (flag filterparent),
//   of <contact><exclude>.
// Joint::collide says so of the two of a joint, an Exclusion of all others.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// Appends an exclusion for every two bodies that could collide if it were not for those rules, and
// that no joint keeps apart. `scene_body`: of each of MuJoCo's bodies that has one. Precondition:
// the scene has its joints.
void add_exclusions(const Model& model, const std::vector<BodyId>& scene_body, Scene& scene);

}  // namespace manyworlds::mjcf
