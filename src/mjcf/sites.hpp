// Sites: points of bodies with names, for those who look at them.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// All sites in MuJoCo's order. `scene_body`: of each of MuJoCo's bodies, none where it has none.
void add_sites(const Model& model, const std::vector<BodyId>& scene_body, Scene& scene);

}  // namespace manyworlds::mjcf
