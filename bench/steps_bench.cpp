// Whole steps of one scene on one thread, from its typical state. The label is the hash of the
// worlds one step later: times of different instruction sets or commits compare only when the
// hashes are equal.
#include <cstdio>
#include <string>

#include "bench/report.hpp"
#include "src/base/float_mode.hpp"
#include "src/dispatch/kernels.hpp"

namespace manyworlds::bench {
namespace {

constexpr int kSteps = 4;  // per iteration; the state stays close to the typical one

void time_steps(benchmark::State& state, const Scenario& scenario, Isa isa) {
  TypicalWorlds& worlds = typical_worlds(scenario, isa);
  const FloatMode mode(FloatMode::flush);
  ContactCounts counts;
  for ([[maybe_unused]] const auto _ : state) {
    double seconds = 0;
    counts = {};
    for (int g = 0; g < worlds.groups(); ++g) {
      worlds.restore(g);
      seconds += seconds_of([&] { worlds.step(g, kSteps, kernels::Layout::automatic); });
      counts.add(worlds.kernels().counters(worlds.scratch()));
    }
    state.SetIterationTime(seconds);
  }
  report(state, worlds, counts);
  state.counters["per_group"] = time_of_one(worlds.groups() * kSteps);
  state.SetItemsProcessed(state.iterations() * kWorlds * kSteps);  // world-steps
  char hash[17];
  std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(worlds.hash()));
  state.SetLabel(hash);
  const std::string wrong = worlds.check(kernels::Layout::automatic);
  if (!wrong.empty()) state.SkipWithError(wrong.c_str());
}

}  // namespace

void register_steps() {
  for (const Scenario& s : scenarios()) {
    for (const Isa isa : benched_isas()) {
      const std::string name = "step/" + s.name + "/" + manyworlds::to_string(isa);
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        time_steps(state, s, isa);
      })->UseManualTime();
    }
  }
}

}  // namespace manyworlds::bench
