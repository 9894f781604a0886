// What a benchmark prints beside its time.
#pragma once

#include <benchmark/benchmark.h>

#include "bench/fixture.hpp"

namespace manyworlds::bench {

void register_stages();
void register_pairs();
void register_steps();
void register_batch();
void register_observers();
void register_sizes();
void register_tasks();
void register_robots();

// Prints as a time: `per_iteration` things are done in each iteration, this is the time of one.
inline benchmark::Counter time_of_one(double per_iteration) {
  return {per_iteration,
          benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert};
}

// Counts of the broad and narrow phase, over all groups.
struct ContactCounts {
  double blocks = 0;      // of the dense layout
  double candidates = 0;  // pairs of shapes, each in one world
  double manifolds = 0;

  void add(const kernels::GroupCounters& c) {
    blocks += c.dense_blocks;
    candidates += c.active;
    manifolds += c.manifolds;
  }
};

inline void report(benchmark::State& state, const TypicalWorlds& worlds,
                   const ContactCounts& counts) {
  state.counters["lanes"] = worlds.kernels().lanes;
  state.counters["per_group"] = time_of_one(worlds.groups());
  state.counters["blocks"] = counts.blocks / worlds.groups();
  state.counters["candidates"] = counts.candidates / kWorlds;
  state.counters["manifolds"] = counts.manifolds / kWorlds;
}

}  // namespace manyworlds::bench
