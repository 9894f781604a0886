// TaskRunner: works out a task around the steps of groups of worlds, in the batch's number type.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "manyworlds/environment.hpp"
#include "src/base/aligned_buffer.hpp"
#include "src/step/group_visitor.hpp"
#include "src/task/program.hpp"

namespace manyworlds {

// The programs of a task and which rows of them are what.
struct TaskPrograms {
  TaskPrograms(const Task& task, const Plan& plan);

  InputRows inputs;
  std::vector<std::array<double, 2>> action_range, control_range;
  bool ranges_vary = false;  // of controls, from world to world
  int max_steps;
  Program opening;                // before an episode begins: knows no state of the world
  std::vector<int> level_begins;  // its rows, by level, and those of initial parameters
  std::vector<HostNumber> initial_parameters;
  std::vector<int> initial_values;
  Program before, after;
  std::vector<int> controls;                                   // rows of `before`
  std::vector<int> observations, rewards, infos, level_nexts;  // rows of `after`
  int terminated, truncated;
  Memory memory;
  // Of all this; of a user's function only where it stands, since what it does cannot be told.
  std::uint64_t fingerprint;
};

// The number type's side of an Environment.
class TaskRunner {
 public:
  virtual ~TaskRunner() = default;
  virtual GroupVisitor& visitor() = 0;
  // What is remembered of a world from step to step: numbers() of them.
  virtual std::size_t numbers() const = 0;
  virtual void save_world(int world, std::span<double> to) const = 0;
  virtual void restore_world(int world, std::span<const double> from) = 0;
  virtual double level(int world, std::size_t level) const = 0;
  virtual void set_level(int world, std::size_t level, double value) = 0;

  // Of the call in progress.
  const float* actions = nullptr;         // [world][action], or
  const std::int64_t* choices = nullptr;  // [world]
  StepArrays out;
  bool keeps_last = false;  // worlds that begin leave their last observations
  // [world] worlds that begin after the steps; those that do in the next ones.
  std::vector<std::uint8_t> begin_now, begin_next;
  std::vector<std::uint8_t> unsound;  // [world] whose action or control was not a number
  std::atomic<bool> some_begin = false;
};

std::unique_ptr<TaskRunner> make_runner(std::shared_ptr<const TaskPrograms> programs,
                                        const Batch& batch, Autoreset autoreset);

}  // namespace manyworlds
