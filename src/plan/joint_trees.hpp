// Joints that can be solved at once. Used inside src/plan only.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// Per joint: whether what hangs together with it is a tree that the kernels can solve at once: of
// ball joints without limits, hinges, sliders, fixed and wheel joints, without a loop, on nothing
// or on one body that is not dynamic.
std::vector<bool> joints_of_trees(const Scene& scene);
bool all_in_trees(const Scene& scene);

// Whether no two shapes can touch, by their filters and joints.
bool nothing_touches(const Scene& scene);

}  // namespace manyworlds
