// What the programs of the peers share: one engine's worlds, all on one thread, stepped round robin
// or together by the protocol of `manyworlds bench`, and a line of JSON for each scene.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/peers/scenes.hpp"

namespace manyworlds::peers {

// Of the centres of the lowest and the highest body, m.
struct Heights {
  double lowest = 1e300, highest = -1e300;
  void add(double height) {
    lowest = height < lowest ? height : lowest;
    highest = height > highest ? height : highest;
  }
};

// One world of an engine. The destructor frees it.
class Simulation {
 public:
  Simulation() = default;
  virtual ~Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  virtual void step() = 0;  // kStep
  // Of the state after the last step, m: how far the deepest contact overlaps (0 when none does),
  // and how far the widest joint gapes. Asked for after the clock has stopped.
  virtual double overlap() = 0;
  virtual double gap() = 0;
  virtual Heights heights() = 0;
};

using Simulations = std::vector<std::unique_ptr<Simulation>>;

// All worlds of a scene, at least one, stepped by one call, for engines that can.
class Together {
 public:
  Together() = default;
  virtual ~Together() = default;
  Together(const Together&) = delete;
  Together& operator=(const Together&) = delete;

  virtual void step() = 0;  // kStep
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

// main() of a peer: --scenes A,B --worlds N --warm-up N --steps N, or --list. Returns the exit
// code: 0, 1 when something failed, 2 for a bad command line.
int run_peer(int argc, char** argv, const Engine& engine);

}  // namespace manyworlds::peers
