// Steps of the named robots under random controls, with resets at random times, on one thread.
#include <string>

#include "bench/fixture.hpp"
#include "bench/report.hpp"
#include "manyworlds/batch.hpp"
#include "manyworlds/scenes.hpp"
#include "tools/base/random_controls.hpp"

namespace manyworlds::bench {
namespace {

using tools::RandomControls;

constexpr int kRobots = 1024;
constexpr int kFirstSteps = 500;  // until all have been reset once

void time_robot(benchmark::State& state, const scenes::Entry& entry, Isa isa) {
  BatchOptions options;
  options.worlds = kRobots, options.threads = 1, options.isa = isa;
  Batch batch(compile(entry.make()), options);
  RandomControls controls(batch, options.seed);
  const auto step = [&] { batch.step(RandomControls::kPeriod); };
  while (batch.steps() < kFirstSteps) {
    controls.apply(batch, batch.steps());
    step();
  }
  for ([[maybe_unused]] const auto _ : state) {
    controls.apply(batch, batch.steps());
    state.SetIterationTime(seconds_of(step));
  }
  if (batch.lost_worlds() > 0) return state.SkipWithError("worlds were lost");
  state.counters["worlds/s"] = benchmark::Counter(kRobots * RandomControls::kPeriod,
                                                  benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(batch.kernel_table());
}

}  // namespace

void register_robots() {
  for (const scenes::Entry& entry : scenes::all()) {
    if (!RandomControls::suit(compile(entry.make()))) continue;
    for (const Isa isa : benched_isas()) {
      const std::string name = std::string("robot/") + entry.name + '/' + to_string(isa);
      benchmark::RegisterBenchmark(
          name.c_str(), [&entry, isa](benchmark::State& state) { time_robot(state, entry, isa); })
          ->UseManualTime()
          ->Unit(benchmark::kMillisecond);
    }
  }
}

}  // namespace manyworlds::bench
