// What the programs of the peers share: one engine's worlds, all on one thread, stepped round robin
// or together by the protocol of `manyworlds bench`, and a line of JSON for each scene.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bench/peers/scenes.hpp"

namespace manyworlds::peers {

// Of a body: its centre in the world, m, and how it is turned, rad or w x y z.
struct Pose {
  std::array<double, 3> position{};
  double angle = 0;                            // planar
  std::array<double, 4> rotation{1, 0, 0, 0};  // spatial
};

// One world of an engine. The destructor frees it.
class Simulation {
 public:
  Simulation() = default;
  virtual ~Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  virtual void step() = 0;  // kStep
  // After the last step, of World::bodies in their order. Asked for after the clock has stopped.
  virtual std::vector<Pose> poses() = 0;
};

using Simulations = std::vector<std::unique_ptr<Simulation>>;

// All worlds of a scene, at least one, stepped by one call, for engines that can.
class Together {
 public:
  Together() = default;
  virtual ~Together() = default;
  Together(const Together&) = delete;
  Together& operator=(const Together&) = delete;

  virtual void step(int steps) = 0;  // of kStep each
  // Gives the worlds their states, after the clock has stopped.
  virtual void finish() = 0;
};

struct Engine {
  const char* name;
  std::string version;
  bool planar;  // its scenes are the planar ones, or else the spatial ones
  // What is not the engine's default, and what a reader has to know of the others.
  std::function<std::string(const World&)> settings;
  std::function<std::unique_ptr<Simulation>(const World&)> make;
  // Begins where the worlds are, which it keeps a reference to. None: each world by its step().
  std::function<std::unique_ptr<Together>(const Simulations&)> together;
};

// main() of a peer: --scenes A,B --worlds N --warm-up N --steps N --visit N --poses, or --list.
// Returns the exit code: 0, 1 when something failed, 2 for a bad command line.
int run_peer(int argc, char** argv, const Engine& engine);

}  // namespace manyworlds::peers
