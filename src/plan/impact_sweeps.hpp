// How exactly impacts of several bodies are solved. Used inside src/plan only.
#pragma once

#include <string>

#include "manyworlds/scene.hpp"

namespace manyworlds {

struct SweepsChoice {
  int sweeps = 0;
  std::string why;
};

SweepsChoice choose_impact_sweeps(const Scene& scene);

}  // namespace manyworlds
