// What a user does with a whole Batch between and around steps: 1024 worlds of bin-boxes on one
// thread. docs/batch.md gives these figures.
#include <string>

#include "bench/report.hpp"
#include "manyworlds/scenes.hpp"

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
  scene.options.sleep_speed = 0;
  Batch batch = batch_of(scene, sleep);
  batch.step(120);
  for ([[maybe_unused]] const auto _ : state) batch.step();
  state.SetItemsProcessed(state.iterations() * kManyWorlds);
}

// Every second world is kept awake by small pushes; without sleep they all are.
void time_half_awake(benchmark::State& state, bool sleep) {
  Batch batch = batch_of(bin_boxes(), sleep);
  batch.step(1200);
  for ([[maybe_unused]] const auto _ : state) {
    for (int w = 0; w < kManyWorlds; w += 2) batch.add_impulse(w, 0, Vec3(0, 0, 100));
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
