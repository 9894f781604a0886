// TaskRunner: works out a task around the steps of groups of worlds, in the batch's number type.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "manyworlds/environment.hpp"
#include "src/api/batch_core.hpp"
#include "src/base/aligned_buffer.hpp"
#include "src/step/group_visitor.hpp"
#include "src/task/program.hpp"

namespace manyworlds {

// The programs of a task and which rows of them are what.
struct TaskPrograms {
  // With a row for one more expression, which changes nothing else.
  TaskPrograms(const Task& task, const Plan& plan, const Expression* evaluated = nullptr);

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
  int terminated, truncated;  // `truncated` is 1 in worlds that are lost, too
  // What must be finite: observations, rewards and both ends, with what they are called.
  std::vector<int> results;
  std::vector<std::string> result_names;
  MemoryRows memory;
  int evaluated = -1;
  bool evaluated_is_known = true;  // it depends on nothing that the task does not remember
  // Of all this; of a user's function only where it stands, since what it does cannot be told.
  std::uint64_t fingerprint;

 private:
  void name_results(const Task& task, ProgramBuilder& builder);
};

// A result that was not finite in a call, in the first of its worlds.
struct Fault {
  int result;  // index in TaskPrograms::results
  int world;
  std::int64_t step;  // of the world's episode; 0: where it began
  double value;
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
  // Adds the faults since the last call of this, one for each result, in their order.
  virtual void take_faults(std::vector<Fault>& to) = 0;
  // The row `evaluated` of the programs in all worlds, as it is after the last step or beginning.
  virtual void evaluate(BatchCore& core, const TaskPrograms& programs, std::span<double> out) = 0;

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
