// A program that steps the standard scenes in another engine, and what it prints.
//
// peer_ENGINE (bench/peers): `--list` prints the scenes that it has, and `--scenes NAME --worlds N
// --warm-up N --steps N --visit N --poses` a line of JSON: engine, version, settings,
// world_steps_per_s, and poses, where every body of every world is after the last step.
#pragma once

#include <stdexcept>
#include <string>
#include <vector>

namespace manyworlds::report {

// What a peer did that it should not have; what() goes on after "peer_x failed: ".
class PeerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

struct PeerProgram {
  std::string path, name;
  std::vector<std::string> scenes;
  bool has(const std::string& scene) const;
};

// The programs peer_* of a folder, in order of their names. Throws std::invalid_argument when there
// is none.
std::vector<std::string> find_peers(const std::string& folder);

// The scenes that a program has. Throws PeerError, as below.
PeerProgram list_peer(const std::string& path);

struct PeerProtocol {
  int worlds = 0, warm_up = 0, steps = 0;
  int visit = 1;  // steps of a world before the next one's
};

struct PeerResult {
  std::string engine, version, settings;
  double world_steps_per_s = 0;
  // [world][body][3 or 7], bodies in the scene's order without those that are fixed: x y angle, or
  // x y z and a quaternion w x y z; m and rad.
  std::vector<double> poses;
};

// Throws PeerError when the program fails or prints no such line, and Interrupted.
PeerResult run_peer(const PeerProgram& peer, const std::string& scene,
                    const PeerProtocol& protocol);

}  // namespace manyworlds::report
