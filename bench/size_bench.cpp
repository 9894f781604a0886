// The cost of a step by the size of one world: per body, from some to thousands, for one world and
// for a full group. docs/batch.md gives these figures.
#include <string>

#include "bench/report.hpp"
#include "manyworlds/batch.hpp"

namespace manyworlds::bench {
namespace {

void time_size(benchmark::State& state, const std::string& scene, Isa isa, bool full,
               BroadPhase broad_phase) {
  PlanOptions plan_options;
  plan_options.broad_phase = broad_phase;
  BatchOptions options;
  options.threads = 1;
  options.isa = isa;
  const Plan plan = compile(*scenes::sized(scene), plan_options);
  if (full) options.worlds = Batch(plan, options).lanes();
  Batch batch(plan, options);
  batch.step(60);
  for ([[maybe_unused]] const auto _ : state) batch.step();
  const double bodies = static_cast<double>(plan.bodies()) * batch.worlds();
  state.counters["bodies"] = plan.bodies();
  state.counters["per_body"] = time_of_one(bodies);
  state.counters["bytes_per_world"] = static_cast<double>(batch.bytes_per_world());
  state.counters["scratch"] = static_cast<double>(batch.scratch_bytes());
}

void add(const std::string& scene, Isa isa, bool full, BroadPhase broad_phase) {
  const std::string way =
      broad_phase == BroadPhase::automatic ? "" : std::string("/") + to_string(broad_phase);
  const std::string name =
      "size/" + scene + "/" + manyworlds::to_string(isa) + (full ? "/group" : "/one_world") + way;
  benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
    time_size(state, scene, isa, full, broad_phase);
  });
}

}  // namespace

void register_sizes() {
  for (const Isa isa : benched_isas()) {
    for (const bool full : {false, true}) {
      for (const char* size : {"2", "5", "10", "15", "30", "50", "100"})
        add(std::string("pyramid2d:") + size, isa, full, BroadPhase::automatic);
      for (const char* size : {"4", "20", "64", "100", "500", "1000", "5000"})
        add(std::string("bin-boxes:") + size, isa, full, BroadPhase::automatic);
      // Where listing all pairs ends.
      for (const char* scene : {"bin-boxes:64", "bin-boxes:100", "bin-spheres:64",
                                "bin-spheres:100", "bin-spheres:200"}) {
        for (const auto way :
             {BroadPhase::all_pairs, BroadPhase::sort_and_sweep, BroadPhase::sparse})
          add(scene, isa, full, way);
      }
    }
  }
}

}  // namespace manyworlds::bench
