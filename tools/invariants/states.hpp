// States of worlds: from scenes into a batch, and back as bodies numbered as in the scene.
#pragma once

#include <vector>

#include "tools/invariants/family.hpp"

namespace manyworlds::invariants {

// The initial state of a scene in world `world` of a batch.
void put_state(Batch& batch, int world, const Scene& scene);
std::vector<BodyNow> initial_states(const Scene& scene);

// The states of all worlds of a batch, read in one go.
class States {
 public:
  void read(const Batch& batch);
  // `out` has all bodies of the scene; fixed ones keep what is there.
  void copy(const Batch& batch, int world, std::vector<BodyNow>& out) const;

 private:
  std::vector<double> x_, q_, v_, w_;
};

}  // namespace manyworlds::invariants
