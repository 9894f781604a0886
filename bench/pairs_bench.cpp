// Narrow phase and contact rows of one shape pair at a time: the collide stage with the tables cut
// down to one class of pairs. The scene is the first that has such a class.
#include <set>
#include <string>
#include <tuple>

#include "bench/report.hpp"
#include "src/base/float_mode.hpp"
#include "src/dispatch/kernels.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds::bench {
namespace {

using kernels::PairKind;

void time_pair(benchmark::State& state, const Scenario& scenario, Isa isa, int class_index,
               kernels::Layout layout) {
  TypicalWorlds& worlds = typical_worlds(scenario, isa);
  Tables tables = worlds.tables();
  tables.pair_class += class_index;
  tables.classes = 1;
  StageRunner runner(worlds.kernels(), tables, worlds.scratch(), layout);
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
      runner.run_before(Stage::collide, group);
      seconds += seconds_of([&] { runner.run(Stage::collide, group); });
    }
    state.SetIterationTime(seconds);
  }
  report(state, worlds, counts);
  state.counters["per_candidate"] = time_of_one(counts.candidates);
  state.SetLabel(scenario.name);
  if (counts.candidates == 0) state.SkipWithError("no candidates in the typical state");
  const std::string wrong = worlds.check(layout);
  if (!wrong.empty()) state.SkipWithError(wrong.c_str());
}

}  // namespace

void register_pairs() {
  using Kind = std::tuple<PairKind, bool, bool>;  // against fixed shapes? planar?
  std::set<Kind> seen;
  for (const Scenario& s : scenarios_of_pairs()) {
    const Plan plan = compile(s.make());
    const auto& classes = plan.data().classes;
    const bool planar = plan.scene().space == Space::planar;
    for (std::size_t c = 0; c < classes.size(); ++c) {
      const bool fixed = is_fixed(classes[c].list);
      if (!seen.insert({classes[c].kind, fixed, planar}).second) continue;
      const bool other_space = planar && seen.count({classes[c].kind, fixed, false}) != 0;
      for (const Isa isa : benched_isas()) {
        for (const auto layout : {kernels::Layout::rows, kernels::Layout::dense}) {
          const std::string name = std::string("collide/") + (other_space ? "planar_" : "") +
                                   (fixed && may_both_move(classes[c].kind) ? "fixed_" : "") +
                                   manyworlds::to_string(classes[c].kind) + "/" +
                                   manyworlds::to_string(isa) + "/" + to_string(layout);
          const int index = static_cast<int>(c);
          benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
            time_pair(state, s, isa, index, layout);
          })->UseManualTime();
        }
      }
    }
  }
}

}  // namespace manyworlds::bench
