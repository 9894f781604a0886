// Keyframes of an articulated model, whose qpos, qvel and ctrl are in the scene's order already.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

void add_keyframes(const Model& model, Scene& scene);

// Appends a warning for keyframes that are ignored, or whose time is.
void compare_keyframes(const Model& model, std::vector<std::string>& warnings);

}  // namespace manyworlds::mjcf
