// Other engines beside manyworlds: the standard scenes by one protocol, alternately in one run.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/report/peer_errors.hpp"

namespace manyworlds::report {

inline constexpr int kLongVisit = 16;  // steps of a world before the next one's

struct PeerSpeed {
  double world_steps_per_s = 0;  // median of the rounds
  double ratio = 0;              // how often as fast manyworlds is: median of the rounds' own
};
struct PeerRow {
  std::string engine, version, settings;
  int rounds = 0;                       // that it took part in
  PeerSpeed speed;                      // a step of each world in turn
  std::optional<PeerSpeed> long_visit;  // kLongVisit steps of each; not of slow engines
  PeerErrors errors;
};
struct PeerScene {
  std::string scene;
  double world_steps_per_s = 0, long_visit = 0;  // of manyworlds: step(1), step(kLongVisit)
  PeerErrors errors;
  std::vector<PeerRow> engines;  // the fastest first
};
struct Peers {
  int worlds = 0, steps = 0, rounds = 0;
  std::vector<PeerScene> scenes;
  std::vector<std::string> failures;  // "peer_x failed: ..."
};

struct PeerOptions {
  std::string folder;
  std::vector<std::string> scenes;  // empty: all that one of the peers has
  bool quick = false;
};

// A peer that fails is left out and becomes a line of `failures`. Throws Interrupted; the scenes
// that were done until then are in `out`.
void run_peers(const PeerOptions& options,
               const std::function<void(const std::string&, double)>& tell, Peers& out);

// Geometric means over the scenes of the ratios to the fastest engine of each: a step per visit,
// and kLongVisit on both sides. None where no scene has such a ratio.
struct PeerMeans {
  std::optional<double> ratio, long_visit;
};
PeerMeans means_of(const Peers& peers);

nlohmann::ordered_json to_json(const PeerScene& scene);
nlohmann::ordered_json to_json(const PeerMeans& means);
std::string peers_text(const Peers& peers);

}  // namespace manyworlds::report
