// Bodies that move on joints, as links of trees for Solver::newton. Each of MuJoCo's joints but the
// free ones is a joint between a body and its parent, and several of one body are a series; what
// is welded to a link is held by a fixed joint.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// Appends what of joints other than free ones, and of links, is not simulated.
void check_links(const Model& model, std::vector<std::string>& problems);

// `scene_body`: of each of MuJoCo's bodies that has one. Returns the joint of each of MuJoCo's;
// none for free ones. Precondition: check_links finds nothing.
std::vector<JointId> add_links(const Model& model, const std::vector<BodyId>& scene_body,
                               Scene& scene);

}  // namespace manyworlds::mjcf
