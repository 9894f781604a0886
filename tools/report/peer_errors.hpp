// How good states are, by one measure for all engines: overlaps of shapes as our narrow phase finds
// them and gaps of joints, from nothing but where the bodies are.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::report {

// Of the worst world, m.
struct PeerErrors {
  std::optional<double> overlap, gap;  // of contacts; of joints
};

// Of a batch as it is: gaps where its scene has joints, else overlaps.
PeerErrors errors_of(const Batch& batch);

// Of a standard scene's worlds at these poses (PeerResult::poses). Throws PeerError where they are
// not as many as the scene's bodies in that many worlds, or not finite.
PeerErrors errors_of(const std::string& scene, int worlds, const std::vector<double>& poses);

}  // namespace manyworlds::report
