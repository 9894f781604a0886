// Steps of the named tasks per second, random actions and automatic resets included: `worlds/s` is
// environment steps per second, threads are all that there are.
#include <cstdint>
#include <string>
#include <vector>

#include "bench/report.hpp"
#include "manyworlds/environment.hpp"
#include "manyworlds/tasks.hpp"

namespace manyworlds::bench {
namespace {

constexpr int kTaskWorlds = 4096, kActionSets = 16;

void time_task(benchmark::State& state, const tasks::Entry& entry) {
  const Task task = entry.make();
  Environment environment(task, {.worlds = kTaskWorlds, .autoreset = Autoreset::same_step});
  const auto worlds = static_cast<std::size_t>(kTaskWorlds);
  std::vector<float> seen(worlds * task.observations.size()), last(seen.size());
  std::vector<double> rewards(worlds);
  std::vector<std::uint8_t> terminated(worlds), truncated(worlds);
  const StepArrays out{seen, last, rewards, {}, terminated, truncated};

  // Actions are made beforehand; a linear congruence is random enough for a clock.
  std::vector<std::vector<std::int64_t>> choices(kActionSets, std::vector<std::int64_t>(worlds));
  std::vector<std::vector<float>> numbers(kActionSets,
                                          std::vector<float>(worlds * task.actions.size()));
  std::uint32_t draw = 1;
  const auto next = [&draw] { return (draw = 1664525u * draw + 1013904223u) >> 8; };
  for (auto& set : choices) {
    for (auto& c : set)
      c = task.choices > 0 ? next() % static_cast<std::uint32_t>(task.choices) : 0;
  }
  for (auto& set : numbers) {
    for (std::size_t i = 0; i < set.size(); ++i) {
      const Action& a = task.actions[i % task.actions.size()];
      set[i] = static_cast<float>(a.low + (a.high - a.low) * next() * 0x1p-24);
    }
  }
  std::size_t turn = 0;
  const auto step = [&] {
    const std::size_t set = turn++ % kActionSets;
    if (task.choices > 0) {
      environment.step(std::span<const std::int64_t>(choices[set]), out);
    } else {
      environment.step(std::span<const float>(numbers[set]), out);
    }
  };
  for (int i = 0; i < 100; ++i) step();
  for ([[maybe_unused]] const auto _ : state) step();
  state.counters["worlds/s"] =
      benchmark::Counter(kTaskWorlds, benchmark::Counter::kIsIterationInvariantRate);
  state.SetLabel(environment.batch().kernel_table() + ", " +
                 std::to_string(environment.batch().threads()) + " threads");
}

}  // namespace

void register_tasks() {
  for (const tasks::Entry& entry : tasks::all()) {
    benchmark::RegisterBenchmark((std::string("task/") + entry.name).c_str(),
                                 [&entry](benchmark::State& state) { time_task(state, entry); })
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  }
}

}  // namespace manyworlds::bench
