// Worlds that a judge steps beside the one it looks at, whose plans differ from that one's.
#pragma once

#include <vector>

#include "tools/invariants/draw.hpp"
#include "tools/invariants/states.hpp"

namespace manyworlds::invariants {

std::vector<Family> refinement_families();  // similarity_refinement.cpp

class SideWorlds {
 public:
  SideWorlds(const Scene& plan, Precision precision, int worlds = 1);
  void put(int world, const Scene& initial);  // positions, rotations and velocities
  void step(int steps);
  const BodyNow& now(int world, int body) const {  // number of the body in the scene
    return now_[static_cast<std::size_t>(world)][static_cast<std::size_t>(body)];
  }

 private:
  void read();
  Batch batch_;
  States states_;
  std::vector<std::vector<BodyNow>> now_;  // [world][body]
};

}  // namespace manyworlds::invariants
