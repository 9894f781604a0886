// Joints that can be solved at once. Used inside src/plan only.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// Per joint: whether what hangs together with it is a tree that the kernels can solve at once: of
// ball joints without limits, hinges, sliders, fixed and wheel joints, without a loop, on nothing
// or on one body that is not dynamic.
std::vector<bool> joints_of_trees(const Scene& scene);
// Per body: which such tree it is of, by the lowest of its bodies; -1: none.
std::vector<int> trees_of_bodies(const Scene& scene);

}  // namespace manyworlds
