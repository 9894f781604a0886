// Names of the plan's enumerators, as people type and read them.
#include "manyworlds/plan.hpp"

namespace manyworlds {

const char* to_string(Feature feature) {
  switch (feature) {
    case Feature::orientation: return "orientation";
    case Feature::inertia: return "inertia";
    case Feature::friction: return "friction";
    case Feature::restitution: return "restitution";
    case Feature::contacts: return "contacts";
    case Feature::drag: return "drag";
    case Feature::gravity: return "gravity";
    case Feature::joints: return "joints";
  }
  return "unknown";
}

const char* to_string(BroadPhase broad_phase) {
  switch (broad_phase) {
    case BroadPhase::automatic: return "automatic";
    case BroadPhase::all_pairs: return "all-pairs";
    case BroadPhase::sort_and_sweep: return "sort-and-sweep";
    case BroadPhase::sparse: return "sparse";
  }
  return "unknown";
}

}  // namespace manyworlds
