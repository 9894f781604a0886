// What a user does with a whole Batch between and around steps: 1024 worlds of bin-boxes, or of the
// humanoid, on one thread. docs/batch.md and docs/variations.md give these figures.
#include <algorithm>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "manyworlds/scenes.hpp"
#include "tools/base/median.hpp"

namespace manyworlds::bench {
namespace {

constexpr int kManyWorlds = 1024;

Batch batch_of(const Scene& scene, bool sleep) {
  BatchOptions options;
  options.worlds = kManyWorlds;
  options.threads = 1;
  options.sleep = sleep;
  return Batch(compile(scene), options);
}

Scene bin_boxes() { return scenes::find("bin-boxes")->make(); }

// The typical, moving state: nothing sleeps in it, whether it may or not.
void time_moving_steps(benchmark::State& state, bool sleep) {
  Scene scene = bin_boxes();
  scene.options.sleep.speed = 0;
  Batch batch = batch_of(scene, sleep);
  batch.step(120);
  for ([[maybe_unused]] const auto _ : state) batch.step();
  state.SetItemsProcessed(state.iterations() * kManyWorlds);
}

// The same scene with numbers of its own in every world: they are the scene's, so that both step
// the same states.
// A range of masses that asks for other rows or substeps would make another plan.
std::vector<Variation> friction_and_mass() {
  return {vary(Parameter::friction, 0, 2, Draw::none),
          vary(Parameter::mass, 256, 1024, Draw::none)};
}
std::vector<Variation> joints_and_gains() {
  Variation gain = vary(Parameter::gain, 0, 0, Draw::none);
  gain.low.setConstant(-1e6), gain.high.setConstant(1e6);
  return {vary(Parameter::armature, 0, 1e6, Draw::none),
          vary(Parameter::damping, 0, 1e6, Draw::none), gain};
}
std::vector<Variation> friction_mass_and_motor() {
  return {vary(Parameter::friction, 0, 2, Draw::none), vary(Parameter::mass, 1e-3, 1e6, Draw::none),
          vary(Parameter::motor_speed, -1e3, 1e3, Draw::none)};
}
// In turns, from the same states: what scenes become in the time that one of the two takes longer
// costs more than what varies.
void time_varied_steps(benchmark::State& state, const char* name,
                       const std::vector<Variation>& variations) {
  constexpr int kSteps = 16;
  struct Timed {
    Batch batch;
    Snapshot start;
    explicit Timed(const Scene& scene) : batch(batch_of(scene, false)) {
      batch.step(120);
      start = batch.save();
    }
    double time() {
      batch.restore(start);
      batch.step();  // what was restored is in the caches
      return seconds_of([&] { batch.step(kSteps); });
    }
  };
  Scene scene = scenes::find(name)->make();
  Timed plain(scene);
  scene.variations = variations;
  Timed varied(scene);
  std::vector<double> ratios;
  for ([[maybe_unused]] const auto _ : state) {
    const double before = plain.time(), after = varied.time();
    state.SetIterationTime(after / kSteps);
    ratios.push_back(after / before);
  }
  if (varied.batch.hash() != plain.batch.hash()) state.SkipWithError("the states differ");
  state.counters["of_unvaried"] = tools::median(ratios);
  state.SetItemsProcessed(state.iterations() * kManyWorlds);
}

// New numbers, and all that follows from them, in every world.
void time_new_numbers(benchmark::State& state, Parameter parameter) {
  Scene scene = bin_boxes();
  scene.variations = {vary(Parameter::friction, 0.1, 2), vary(Parameter::mass, 1, 1000)};
  Batch batch = batch_of(scene, false);
  std::vector<double> numbers(batch.size(parameter)), others(numbers.size());
  batch.read(parameter, numbers);
  std::reverse_copy(numbers.begin(), numbers.end(), others.begin());
  for ([[maybe_unused]] const auto _ : state) {
    batch.write(parameter, others);
    std::swap(numbers, others);
  }
  state.counters["per_world"] = time_of_one(kManyWorlds);
}

// Every second world is kept awake by small forces; without sleep they all are.
void time_half_awake(benchmark::State& state, bool sleep) {
  Batch batch = batch_of(bin_boxes(), sleep);
  batch.step(1200);
  for ([[maybe_unused]] const auto _ : state) {
    for (int w = 0; w < kManyWorlds; w += 2)
      batch.add_impulse(w, batch.body_in_row(0), Vec3(0, 0, 100));
    state.SetIterationTime(seconds_of([&] { batch.step(); }));
  }
  state.counters["awake"] = batch.awake_fraction();
  state.SetItemsProcessed(state.iterations() * kManyWorlds);
}

template <class Work>
void time_snapshots(benchmark::State& state, Work work) {
  Batch batch = batch_of(bin_boxes(), false);
  batch.step(120);
  const Snapshot snapshot = batch.save();
  for ([[maybe_unused]] const auto _ : state) work(batch, snapshot);
  state.counters["per_world"] = time_of_one(kManyWorlds);
  state.counters["bytes"] = static_cast<double>(snapshot.size()) / kManyWorlds;
}

}  // namespace

void register_batch() {
  for (const bool sleep : {false, true}) {
    const std::string suffix = sleep ? "/sleep_on" : "/sleep_off";
    benchmark::RegisterBenchmark(("batch/moving" + suffix).c_str(), time_moving_steps, sleep);
    benchmark::RegisterBenchmark(("batch/half_awake" + suffix).c_str(), time_half_awake, sleep)
        ->UseManualTime();
  }
  using Variations = std::vector<Variation>;
  const auto add_varied = [](const char* name, const char* scene, const Variations& variations) {
    benchmark::RegisterBenchmark(name, time_varied_steps, scene, variations)
        ->UseManualTime()
        ->Iterations(40);
  };
  add_varied("batch/varied/friction_and_mass", "bin-boxes", friction_and_mass());
  add_varied("batch/varied/car3d_friction_mass_and_motor", "car3d", friction_mass_and_motor());
  add_varied("batch/varied/humanoid_joints_and_gains", "humanoid", joints_and_gains());
  benchmark::RegisterBenchmark("batch/write/friction", time_new_numbers, Parameter::friction);
  benchmark::RegisterBenchmark("batch/write/mass", time_new_numbers, Parameter::mass);
  const auto add = [](const char* name, auto work) {
    benchmark::RegisterBenchmark(name,
                                 [work](benchmark::State& state) { time_snapshots(state, work); });
  };
  add("batch/save", [](Batch& batch, const Snapshot&) { benchmark::DoNotOptimize(batch.save()); });
  add("batch/restore", [](Batch& batch, const Snapshot& s) { batch.restore(s); });
  add("batch/copy_world", [](Batch& batch, const Snapshot&) {
    for (int w = 0; w + 1 < kManyWorlds; ++w) batch.copy_world(w + 1, w);
  });
}

}  // namespace manyworlds::bench
