// What of a model we simulate as MuJoCo does, what differs a little, and what we cannot do.
#pragma once

#include <string>
#include <vector>

#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

// Every element that would change the motion and that we do not simulate: "PLACE: found; expected".
// Empty means that make_scene() (convert.hpp) can represent the model.
std::vector<std::string> unsupported(const Model& model);

// Every difference that is only in how stiff or how accurate MuJoCo's contacts are, and what is
// read but has no effect. One sentence per kind, naming the first element and counting the others.
std::vector<std::string> differences(const Model& model);

}  // namespace manyworlds::mjcf
