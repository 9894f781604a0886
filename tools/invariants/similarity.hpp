// Worlds that a judge steps beside the one it looks at, whose plans differ from that one's.
#pragma once

#include <vector>

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {

std::vector<Family> refinement_families();  // similarity_refinement.cpp

// float32 if all velocities are, which holds by chance for none that moves.
Precision precision_of(const std::vector<BodyNow>& moving);

class SideWorlds {
 public:
  SideWorlds(const Scene& plan, Precision precision, int worlds = 1);
  void put(int world, const Scene& initial);  // positions, rotations and velocities
  void step(int steps);
  const BodyNow& now(int world, int body) const;  // number of the body in the scene

 private:
  void read();
  Batch batch_;
  std::size_t bodies_;
  std::vector<BodyNow> now_;
  std::vector<double> x_, q_, v_, w_;
};

}  // namespace manyworlds::invariants
