// How often a step finds contacts. Used inside src/plan only.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds {

inline constexpr int kMostPasses = 32;  // that a plan chooses

struct PassChoice {
  int passes = 1;
  std::string why;
};

// Chooses for all worlds of a plan: `extremes` as for choose_substeps().
PassChoice choose_passes(const std::vector<Scene>& extremes);

}  // namespace manyworlds
