// Actions for tasks in tests: drawn by counter, so that a world gets the same whatever the batch.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "manyworlds/environment.hpp"
#include "src/base/random.hpp"

namespace manyworlds::test {

// An environment with arrays for what it takes and gives.
struct Played {
  Environment environment;
  std::vector<float> observations, final_observations, actions;
  std::vector<double> rewards, reward_terms;
  std::vector<std::uint8_t> terminated, truncated;
  std::vector<std::int64_t> choices;

  Played(const Task& task, const EnvironmentOptions& options) : environment(task, options) {
    const std::size_t worlds = size(environment.worlds());
    observations.resize(worlds * size(environment.observations()));
    final_observations = observations;
    actions.resize(worlds * size(environment.actions()));
    choices.resize(worlds);
    rewards.resize(worlds);
    reward_terms.resize(worlds * task.rewards.size());
    terminated.resize(worlds);
    truncated.resize(worlds);
    environment.begin(all(), observations);
  }

  std::vector<std::uint8_t> all() const {
    return std::vector<std::uint8_t>(size(environment.worlds()), 1);
  }
  StepArrays arrays() {
    return {observations, final_observations, rewards, reward_terms, terminated, truncated};
  }
  void step() {
    environment.task().choices > 0
        ? environment.step(std::span<const std::int64_t>(choices), arrays())
        : environment.step(std::span<const float>(actions), arrays());
  }
  bool ended(int world) const { return terminated[size(world)] || truncated[size(world)]; }

  // World w acts as world first + w would by itself.
  void act_at_random(int step, int first = 0) {
    const Task& task = environment.task();
    for (int w = 0; w < environment.worlds(); ++w) {
      const Draws draws(1000 + static_cast<std::uint64_t>(first + w),
                        static_cast<std::uint64_t>(step));
      choices[size(w)] = static_cast<std::int64_t>(draws.uniform(0) * std::max(1, task.choices));
      for (std::size_t i = 0; i < task.actions.size(); ++i) {
        const Action& a = task.actions[i];
        actions[size(w) * task.actions.size() + i] =
            static_cast<float>(a.low + (a.high - a.low) * draws.uniform(i));
      }
    }
  }

  static std::size_t size(int n) { return static_cast<std::size_t>(n); }
};

}  // namespace manyworlds::test
