// Joints that can be solved at once. Used inside src/plan only.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// What hangs together as trees that the kernels can solve at once: of ball joints,
// hinges, sliders, fixed and wheel joints. A few of them without drives or limits may close loops,
// or hold to more than one thing that is not dynamic, where none begins apart or may break.
struct SceneTrees {
  std::vector<bool> has_joint;   // [joint]
  std::vector<int> of_body;      // [body] which tree, by one of its bodies; -1: none
  std::vector<int> joints_with;  // [body] joints of its tree
};
SceneTrees trees_of(const Scene& scene);

// What a joint's coordinates are driven or limited by stands in the pivots of a tree: such a joint
// does not close a loop.
bool has_bounds(const Joint& joint);
bool may_break(const Joint& joint);

}  // namespace manyworlds
