// From a supported model to a Scene.
#pragma once

#include <string>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// Precondition: unsupported(model) is empty. `name` is the scene's.
Scene make_scene(const Model& model, const std::string& name);

}  // namespace manyworlds::mjcf
