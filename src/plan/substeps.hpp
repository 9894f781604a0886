// How many substeps a scene takes with the default solver. Used inside src/plan only.
//
// Contacts are as stiff as springs of w = pi / (2 h) rad/s between moving bodies (ContactOptions),
// so what sags or leans under a load wants a certain w, and by that a certain h = dt / n. What is
// written at run time is not known, and does not count.
#pragma once

#include <string>

#include "manyworlds/scene.hpp"

namespace manyworlds {

inline constexpr int kLeastSubsteps = 4, kMostSubsteps = 64;
inline constexpr double kContactShare = 0.25;  // of the substeps' rate is the frequency of contacts

struct SubstepChoice {
  int substeps = kLeastSubsteps;
  int stiff = kLeastSubsteps;  // as many would do were masses alike: contacts are as stiff as these
  std::string why;             // of `substeps`
};

// Of one world's numbers. `length_unit` in m.
SubstepChoice choose_substeps(const Scene& scene, double length_unit);

// w that the columns standing in a scene want, rad/s, and the body on top of the one that wants
// most (columns.cpp).
struct ColumnNeed {
  double w = 0;
  int bodies = 0;
  BodyId top = {};
  bool leans = false;  // and not sags
};
ColumnNeed need_of_columns(const Scene& scene);

}  // namespace manyworlds
