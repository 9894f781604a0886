// Scenes in which every member is set, and copies of them that differ in one member each.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/scene.hpp"

namespace manyworlds::test {

// Every shape, joint, control kind and optional member; valid or not does not matter. With
// Solver::tgs_soft all options have their defaults; others come with more that counts.
inline constexpr Solver kSolversOfEverything[] = {Solver::tgs_soft, Solver::sor, Solver::newton};
Scene scene_with_everything(Solver solver);

struct Change {
  std::string member;  // "bodies/3/shapes/0/density"
  bool counts;         // in the fingerprint of the scene before or after (members.hpp)
  Scene scene;
};
// One for each number, text, choice and presence in the scene.
std::vector<Change> changes_of(const Scene& scene);

}  // namespace manyworlds::test
