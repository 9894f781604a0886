// Joints that can be solved at once. Used inside src/plan only.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

// What hangs together as trees that the kernels can solve at once: of ball joints,
// hinges, sliders, fixed and wheel joints. A few of them without drives or limits may close loops,
// or hold to more than one thing that is not dynamic, where none may break.
struct SceneTrees {
  std::vector<bool> has_joint;  // [joint]
  // [joint] m: what a joint of a loop begins apart by, and a hundredth of its arms; 0 where it
  // begins apart by less than that. In a loop there may be no way to close all of them at once, and
  // then what hangs together would be flung about.
  std::vector<double> slack;
  std::vector<int> of_body;          // [body] which tree, by one of its bodies; -1: none
  std::vector<int> hangs_with;       // [body] trees and all that joints hang on them; -1: none
  std::vector<int> joints_hanging;   // [body] joints of these
  std::vector<int> joints_with;      // [body] joints of its tree
  std::vector<int> joints_in_loops;  // [body] of those the ones that are part of loops
  std::vector<double> inverse_arms;  // [body] 1/m, their sum over these
};
SceneTrees trees_of(const Scene& scene);

// What a joint's coordinates are driven or limited by stands in the pivots of a tree: such a joint
// does not close a loop.
bool has_bounds(const Joint& joint);
bool may_break(const Joint& joint);

inline std::string joint_text(std::size_t j) { return "joint " + std::to_string(j); }

}  // namespace manyworlds
