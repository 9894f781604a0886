// What all benchmarks stand on: a few worlds of a scene in a typical state that is put back before
// every measurement, and the stages of a step one by one.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <vector>

#include "manyworlds/scenes.hpp"
#include "src/base/aligned_buffer.hpp"
#include "src/state/worlds.hpp"
#include "src/step/pipeline.hpp"

namespace manyworlds::bench {

using Kernels = kernels::Kernels<float>;
using Tables = kernels::SceneConstants<float>;
using Group = kernels::GroupView<float>;

// Worlds of every fixture: one register of the widest instruction set. All instruction sets step
// the same worlds, in one group or several, so their times can be compared.
inline constexpr int kWorlds = 16;

// A scene and how many steps take it to its typical state.
struct Scenario {
  std::string name;
  Scene (*make)();
  int steps;
};
const std::vector<Scenario>& scenarios();           // named scenes
const std::vector<Scenario>& scenarios_of_pairs();  // these, then scenes with fixed obstacles

enum class Stage {
  free_motion,
  begin,
  broad_phase,
  choose_layout,
  enter,
  collide,
  warm_start,
  bias,
  advance,
  relax,
  next,
  restitute,
  store,
  leave
};
const char* to_string(Stage stage);
const char* to_string(kernels::Layout layout);

// The stages of one step in the order of src/step/pipeline.cpp.
std::vector<Stage> stages_of_step(const Tables& tables);

// Runs stages on a group. Tables may be those of the worlds, or a part of their pair classes.
class StageRunner {
 public:
  StageRunner(const Kernels& kernels, const Tables& tables, kernels::Scratch* scratch,
              kernels::Layout wish)
      : kernels_(kernels), tables_(tables), scratch_(scratch), wish_(wish), layout_(wish) {}

  void run(Stage stage, const Group& group);
  void run_before(Stage stage, const Group& group);   // all that comes before its first run
  kernels::Layout layout() const { return layout_; }  // what choose_layout chose
  const kernels::GroupCounters& counters() const { return kernels_.counters(scratch_); }

 private:
  const Kernels& kernels_;
  const Tables& tables_;
  kernels::Scratch* scratch_;
  kernels::Layout wish_, layout_;
};

class TypicalWorlds {
 public:
  // Throws std::runtime_error when a world is frozen on the way.
  TypicalWorlds(const Plan& plan, const Kernels& kernels, int steps);

  const Kernels& kernels() const { return kernels_; }
  const Tables& tables() const { return worlds_.tables(); }
  kernels::Scratch* scratch() const { return scratch_; }
  int groups() const { return worlds_.storage().groups(); }
  Group group(int index) const { return worlds_.storage().group(index); }

  void restore(int group);
  void step(int group, int steps, kernels::Layout layout) const;
  // Steps every world once, stage by stage: empty if that gives the bits that step_group gives,
  // else what is wrong.
  std::string check(kernels::Layout layout);
  std::uint64_t hash() const { return hash_; }  // of all worlds one step after the typical state

 private:
  struct Saved {
    unsigned char* live;
    std::vector<unsigned char> bytes;
  };

  template <class T>
  static void save(std::vector<Saved>& to, T* live, int count);
  std::uint64_t current_hash() const;

  const Kernels& kernels_;
  Worlds<float> worlds_;
  StageList<float> stages_;
  AlignedBuffer<unsigned char> scratch_memory_;
  kernels::Scratch* scratch_;
  std::vector<std::vector<Saved>> saved_;  // per group
  std::uint64_t hash_ = 0;
};

// The instruction sets that this CPU and this build have float32 kernels for.
std::vector<Isa> benched_isas();

// The worlds of a scenario, made at the first call and kept.
TypicalWorlds& typical_worlds(const Scenario& scenario, Isa isa,
                              BroadPhase broad_phase = BroadPhase::automatic);

template <class Call>
double seconds_of(Call call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace manyworlds::bench
