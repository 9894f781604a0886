// Other engines beside manyworlds: the standard scenes by one protocol, alternately in one run.
//
// A peer is a program peer_ENGINE (bench/peers). `--list` prints the scenes that it has, and
// `--scenes NAME --worlds N --warm-up N --steps N` a line of JSON: engine, version, settings,
// world_steps_per_s, worst_overlap_m and worst_gap_m (null where there is none).
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

namespace manyworlds::report {

// How far the worst world is from what it should be after the last step, m.
struct PeerErrors {
  std::optional<double> overlap, gap;  // of contacts; of joints
};
struct PeerRow {
  std::string engine, version, settings;
  double world_steps_per_s = 0;  // median of the rounds
  double ratio = 0;              // how often as fast manyworlds is: median of the rounds' own
  PeerErrors errors;
};
struct PeerScene {
  std::string scene;
  double world_steps_per_s = 0;  // of manyworlds
  PeerErrors errors;
  std::vector<PeerRow> engines;
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

// The programs peer_* of a folder, in order of their names. Throws std::invalid_argument when there
// is none.
std::vector<std::string> find_peers(const std::string& folder);

// A peer that fails is left out and becomes a line of `failures`. Throws Interrupted; the scenes
// that were done until then are in `out`.
void run_peers(const PeerOptions& options,
               const std::function<void(const std::string&, double)>& tell, Peers& out);

nlohmann::ordered_json to_json(const PeerScene& scene);
std::string peers_text(const Peers& peers);

}  // namespace manyworlds::report
