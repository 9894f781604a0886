// One stage of the step at a time. The stages before it run untimed in every iteration, so that
// data and caches are as the step finds them.
#include <string>

#include "bench/report.hpp"
#include "src/base/float_mode.hpp"
#include "src/dispatch/kernels.hpp"

namespace manyworlds::bench {
namespace {

void time_stage(benchmark::State& state, const Scenario& scenario, Isa isa, Stage stage,
                kernels::Layout layout, BroadPhase broad_phase) {
  TypicalWorlds& worlds = typical_worlds(scenario, isa, broad_phase);
  StageRunner runner(worlds.kernels(), worlds.tables(), worlds.scratch(), layout);
  const FloatMode mode(FloatMode::flush);
  ContactCounts counts;
  for (int g = 0; g < worlds.groups(); ++g) {
    worlds.restore(g);
    runner.run_before(Stage::warm_start, worlds.group(g));
    if (runner.layout() != layout)
      return state.SkipWithError("too many contact blocks for this layout");
    counts.add(runner.counters());
  }
  for ([[maybe_unused]] const auto _ : state) {
    double seconds = 0;
    for (int g = 0; g < worlds.groups(); ++g) {
      const Group group = worlds.group(g);
      worlds.restore(g);
      runner.run_before(stage, group);
      seconds += seconds_of([&] { runner.run(stage, group); });
    }
    state.SetIterationTime(seconds);
  }
  report(state, worlds, counts);
  const std::string wrong = worlds.check(layout);
  if (!wrong.empty()) state.SkipWithError(wrong.c_str());
}

void time_free_motion(benchmark::State& state, const Scenario& scenario, Isa isa, int steps) {
  TypicalWorlds& worlds = typical_worlds(scenario, isa);
  const FloatMode mode(FloatMode::flush);
  for ([[maybe_unused]] const auto _ : state) {
    double seconds = 0;
    for (int g = 0; g < worlds.groups(); ++g) {
      worlds.restore(g);
      seconds += seconds_of([&] { worlds.step(g, steps, kernels::Layout::automatic); });
    }
    state.SetIterationTime(seconds);
  }
  state.counters["lanes"] = worlds.kernels().lanes;
  state.counters["per_group"] = time_of_one(worlds.groups());
  const std::string wrong = worlds.check(kernels::Layout::automatic);
  if (!wrong.empty()) state.SkipWithError(wrong.c_str());
}

void add(const Scenario& s, Isa isa, Stage stage, kernels::Layout layout, BroadPhase broad_phase,
         const std::string& variant) {
  const std::string name = std::string(to_string(stage)) + "/" + s.name + "/" +
                           manyworlds::to_string(isa) + (variant.empty() ? "" : "/" + variant);
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    time_stage(state, s, isa, stage, layout, broad_phase);
  })->UseManualTime();
}

void register_scenario(const Scenario& s, Isa isa) {
  using kernels::Layout;
  const Plan plan = compile(s.make());
  if (!plan.has(Feature::contacts)) {
    for (const int steps : {1, 16}) {
      const std::string name = "free_motion/" + s.name + "/" + manyworlds::to_string(isa) + "/" +
                               std::to_string(steps) + "_steps";
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        time_free_motion(state, s, isa, steps);
      })->UseManualTime();
    }
    return;
  }
  add(s, isa, Stage::begin, Layout::rows, BroadPhase::automatic, "");
  for (const auto b : {BroadPhase::all_pairs, BroadPhase::sort_and_sweep, BroadPhase::sparse}) {
    add(s, isa, Stage::broad_phase, Layout::rows, b,
        b == BroadPhase::all_pairs        ? "all_pairs"
        : b == BroadPhase::sort_and_sweep ? "sort_and_sweep"
                                          : "sparse");
  }
  add(s, isa, Stage::choose_layout, Layout::rows, BroadPhase::automatic, "");
  for (const auto stage :
       {Stage::enter, Stage::collide, Stage::warm_start, Stage::bias, Stage::advance, Stage::relax,
        Stage::next, Stage::restitute, Stage::store, Stage::leave}) {
    if (stage == Stage::restitute && !plan.has(Feature::restitution)) continue;
    for (const auto layout : {Layout::rows, Layout::dense}) {
      add(s, isa, stage, layout, BroadPhase::automatic, to_string(layout));
    }
  }
}

// What a measurement adds to every call: reading the clock.
void time_nothing(benchmark::State& state) {
  for ([[maybe_unused]] const auto _ : state) state.SetIterationTime(seconds_of([] {}));
}

}  // namespace

void register_stages() {
  benchmark::RegisterBenchmark("clock", time_nothing)->UseManualTime();
  for (const Isa isa : benched_isas()) {
    for (const Scenario& s : scenarios()) register_scenario(s, isa);
  }
}

}  // namespace manyworlds::bench
