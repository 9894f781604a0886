// The order in which a scene's bodies are links of trees, and the joints of each: that of joint
// coordinates. Used inside src only.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

struct TreeOrder {
  // [body] its joints from its parent on; a series has the order of the scene (check_trees.cpp).
  std::vector<std::vector<int>> series;
  std::vector<int> parent;  // [body]; -1: none that moves
  // Those that move: a root, then its descendants, children in the order of the scene.
  std::vector<int> links;
};
// Precondition: the scene's trees are sound.
TreeOrder tree_order(const Scene& scene);

}  // namespace manyworlds
