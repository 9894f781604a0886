// Steps of the named tasks, with random actions and automatic resets: `worlds/s` is environment
// steps per second on all threads that there are. Beside it one thread's processor time for a step
// of one world, in the whole and of its scene alone (the same worlds, without actions): what a task
// adds to its physics.
#include <cstdint>
#include <random>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "manyworlds/environment.hpp"
#include "manyworlds/tasks.hpp"

namespace manyworlds::bench {
namespace {

constexpr int kTaskWorlds = 4096, kActionSets = 16, kWarmUp = 300;

// An environment with room for what it gives, and actions for it that were made beforehand.
class Rollout {
 public:
  Rollout(const Task& task, int threads)
      : environment(task,
                    {.worlds = kTaskWorlds, .threads = threads, .autoreset = Autoreset::same_step}),
        choices_(kActionSets, std::vector<std::int64_t>(kTaskWorlds)),
        numbers_(kActionSets, std::vector<float>(kTaskWorlds * task.actions.size())),
        seen_(kTaskWorlds * task.observations.size()),
        last_(seen_.size()),
        rewards_(kTaskWorlds),
        terminated_(kTaskWorlds),
        truncated_(kTaskWorlds),
        discrete_(task.choices > 0) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> share;
    for (auto& set : choices_) {
      for (auto& c : set) c = static_cast<std::int64_t>(share(random) * task.choices);
    }
    for (auto& set : numbers_) {
      for (std::size_t i = 0; i < set.size(); ++i) {
        const Action& a = task.actions[i % task.actions.size()];
        set[i] = static_cast<float>(a.low + (a.high - a.low) * share(random));
      }
    }
    for (int i = 0; i < kWarmUp; ++i) step();
  }

  void step() {
    const std::size_t set = turn_++ % kActionSets;
    const StepArrays out{seen_, last_, rewards_, {}, terminated_, truncated_};
    if (discrete_) {
      environment.step(std::span<const std::int64_t>(choices_[set]), out);
    } else {
      environment.step(std::span<const float>(numbers_[set]), out);
    }
  }

  Environment environment;

 private:
  std::vector<std::vector<std::int64_t>> choices_;
  std::vector<std::vector<float>> numbers_;
  std::vector<float> seen_, last_;
  std::vector<double> rewards_;
  std::vector<std::uint8_t> terminated_, truncated_;
  bool discrete_;
  std::size_t turn_ = 0;
};

void label(benchmark::State& state, const Batch& batch) {
  state.SetLabel(batch.kernel_table() + ", " + std::to_string(batch.threads()) +
                 (batch.threads() == 1 ? " thread" : " threads"));
}
void count_worlds(benchmark::State& state) {
  state.counters["worlds/s"] =
      benchmark::Counter(kTaskWorlds, benchmark::Counter::kIsIterationInvariantRate);
}
// s of processor time.
void time_a_world(benchmark::State& state, int steps = 1) {
  state.counters["world_step"] =
      benchmark::Counter(kTaskWorlds * steps, benchmark::Counter::kIsIterationInvariantRate |
                                                  benchmark::Counter::kInvert);
}

void time_task(benchmark::State& state, const tasks::Entry& entry) {
  Rollout rollout(entry.make(), 0);
  for ([[maybe_unused]] const auto _ : state) rollout.step();
  count_worlds(state);
  label(state, rollout.environment.batch());
}

void time_on_one_thread(benchmark::State& state, const tasks::Entry& entry) {
  Rollout rollout(entry.make(), 1);
  for ([[maybe_unused]] const auto _ : state) rollout.step();
  time_a_world(state);
  label(state, rollout.environment.batch());
}

void time_scene_alone(benchmark::State& state, const tasks::Entry& entry) {
  constexpr int kSteps = 8;  // from the same states, so that worlds stay what a rollout makes them
  const Task task = entry.make();
  Rollout rollout(task, 1);
  Batch& batch = rollout.environment.batch();
  const Snapshot met = batch.save();
  for ([[maybe_unused]] const auto _ : state) {
    state.PauseTiming();
    batch.restore(met);
    state.ResumeTiming();
    for (int i = 0; i < kSteps; ++i) batch.step(task.frame_skip);
  }
  time_a_world(state, kSteps);
  label(state, batch);
}

}  // namespace

void register_tasks() {
  for (const tasks::Entry& entry : tasks::all()) {
    const std::string name = std::string("task/") + entry.name;
    const auto add = [&](const std::string& what, auto time) {
      return benchmark::RegisterBenchmark(
                 what.c_str(), [&entry, time](benchmark::State& state) { time(state, entry); })
          ->Unit(benchmark::kMillisecond);
    };
    add(name, time_task)->UseRealTime();
    add(name + "/one_thread", time_on_one_thread);
    add(name + "/one_thread/scene_alone", time_scene_alone);
  }
}

}  // namespace manyworlds::bench
