// Whether a scene's joints are solved at once. Used inside src/plan only.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// Why they are, by what sweeps of four substeps do not hold; empty: they are swept over, which is
// faster. `extremes` (plan_data.hpp); `length_unit` in m.
std::string need_of_trees(const std::vector<Scene>& extremes, double length_unit);

}  // namespace manyworlds
