// What an Environment consists of, and the order in which a step calls batch and runner.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "src/api/batch_data.hpp"
#include "src/task/runner.hpp"

namespace manyworlds {

inline void check_array(const char* name, std::size_t found, std::size_t wanted,
                        bool may_be_empty) {
  if (found == wanted || (found == 0 && may_be_empty)) return;
  reject(std::string(name) + " are " + std::to_string(wanted) + " values, the buffer has " +
         std::to_string(found));
}

struct Environment::Impl {
  static constexpr const char* kName = "Environment";

  Task task;
  Autoreset autoreset;
  Plan plan;
  std::shared_ptr<const TaskPrograms> programs;
  Batch batch;
  std::unique_ptr<TaskRunner> runner;
  // Of a step that was ended early: the physics steps that are still to take, and its actions.
  int steps_left = 0;
  std::vector<float> actions;
  std::vector<std::int64_t> choices;
  // Faults of the call, and the first one of each result so far. They have room for all.
  std::vector<Fault> faults, named;
  bool check_finite;

  Impl(const Task& t, const EnvironmentOptions& options);

  std::size_t worlds() const { return static_cast<std::size_t>(batch.worlds()); }
  std::size_t observations() const { return worlds() * task.observations.size(); }
  std::size_t infos() const { return worlds() * task.infos.size(); }
  bool discrete() const { return task.choices > 0; }

  void check(const StepArrays& out) const {
    check_pair("observations", out.observations, "final_observations", out.final_observations,
               observations());
    check_pair("observations_f64", out.observations_f64, "final_observations_f64",
               out.final_observations_f64, observations());
    check_pair("infos", out.infos, "final_infos", out.final_infos, infos());
    check_array("rewards", out.rewards.size(), worlds(), true);
    check_array("reward_terms", out.reward_terms.size(), worlds() * task.rewards.size(), true);
    check_array("terminated", out.terminated.size(), worlds(), true);
    check_array("truncated", out.truncated.size(), worlds(), true);
    check_array("lost", out.lost.size(), worlds(), true);
  }

  template <class T>
  static void check_pair(const char* name, std::span<T> own, const char* final_name,
                         std::span<T> last, std::size_t wanted) {
    check_array(name, own.size(), wanted, true);
    check_array(final_name, last.size(), wanted, true);
    if (own.empty() && !last.empty()) {
      reject(std::string(final_name) + " are given without " + name);
    }
  }

  void check(const EnvironmentSnapshot& snapshot) const {
    if (snapshot.task != programs->fingerprint) {
      throw SnapshotError("snapshot: belongs to another task than '" + task.name + "'");
    }
    const std::size_t wanted =
        static_cast<std::size_t>(snapshot.worlds.worlds()) * runner->numbers();
    if (snapshot.memory.size() != wanted) {
      throw SnapshotError("snapshot: the task's memory has " +
                          std::to_string(snapshot.memory.size()) + " values, must be " +
                          std::to_string(wanted));
    }
  }
  std::span<const double> memory(const EnvironmentSnapshot& snapshot, int world) const {
    const std::size_t n = runner->numbers();
    return std::span(snapshot.memory).subspan(static_cast<std::size_t>(world) * n, n);
  }

  // Worlds are only saved, stepped and begun one by one where they stand between two steps.
  void check_between_steps(const char* call) const {
    if (steps_left == 0) return;
    const int taken = task.frame_skip - steps_left;
    reject(std::string(call) + ": a step was interrupted after " + std::to_string(taken) +
           " of its " + std::to_string(task.frame_skip) +
           " physics steps: finish_step completes it; a reset, begin or restore of all worlds "
           "discards it");
  }
  // What begins all worlds gives up a step in whose middle they stand.
  void check_to_begin(const char* call, std::span<const std::uint8_t> mask,
                      const BeginArrays& out) const {
    check_array("the mask's entries", mask.size(), worlds(), false);
    check_array("observations", out.observations.size(), observations(), true);
    check_array("observations_f64", out.observations_f64.size(), observations(), true);
    check_array("infos", out.infos.size(), infos(), true);
    const auto begins = [](std::uint8_t begin) { return begin != 0; };
    if (!std::all_of(mask.begin(), mask.end(), begins)) check_between_steps(call);
  }

  bool step(const float* numbers, const StepArrays& out, const GoOn& go_on) {
    return step(numbers, worlds() * task.actions.size(), runner->actions, actions, out, go_on);
  }
  bool step(const std::int64_t* each, const StepArrays& out, const GoOn& go_on) {
    return step(each, worlds(), runner->choices, choices, out, go_on);
  }
  // Of `count` actions. Those of a step that ends early are kept for finish_step.
  template <class Number>
  bool step(const Number* in, std::size_t count, const Number*& read, std::vector<Number>& kept,
            const StepArrays& out, const GoOn& go_on) {
    if (go_on) kept.reserve(count);  // no allocation may fail once steps were taken
    read = in;
    Asked asked(go_on);
    const bool whole = advance(*batch.impl_, out, asked);
    if (!whole) kept.assign(in, in + count);
    asked.rethrow();
    return whole;
  }
  bool finish_step(const StepArrays& out, const GoOn& go_on) {
    if (discrete()) {
      runner->choices = choices.data();
    } else {
      runner->actions = actions.data();
    }
    Asked asked(go_on);
    const bool whole = advance(*batch.impl_, out, asked);
    asked.rethrow();
    return whole;
  }

  // A step, or what is left of it. An empty `go_on` is not asked.
  bool advance(Batch::Impl& b, const StepArrays& out, Asked& go_on) {
    const bool begins = steps_left == 0;
    const int n = begins ? task.frame_skip : steps_left;
    runner->out = out;
    runner->some_begin = false;
    const Visit visit{&runner->visitor(), begins};
    const int taken = b.step(n, {}, go_on, visit);
    b.steps += taken;
    tell_step(b, taken, begins);
    steps_left = n - taken;
    faults.clear();
    if (steps_left == 0) {
      runner->take_faults(faults);
      begin_some(b);
    }
    forget_call();
    name_faults();
    return steps_left == 0;
  }

  // The next episodes of worlds whose last has ended.
  void begin_some(Batch::Impl& b) {
    if (!runner->some_begin) return;
    runner->keeps_last = autoreset == Autoreset::same_step;
    b.core->begin(*b.executor, runner->begin_now, {.resets = true}, runner->visitor());
    tell_resets(b, runner->begin_now);
  }

  void begin(Batch::Impl& b, std::span<const std::uint8_t> mask, const Beginning& how,
             const BeginArrays& out) {
    runner->out = {};
    runner->out.observations = out.observations;
    runner->out.observations_f64 = out.observations_f64;
    runner->out.infos = out.infos;
    runner->keeps_last = false;
    b.core->begin(*b.executor, mask, how, runner->visitor());
    if (how.resets) tell_resets(b, mask);
    steps_left = 0;
    forget_call();
    faults.clear();
    name_faults();
  }

  NonFinite describe(const Fault& fault) const {
    return {programs->result_names[static_cast<std::size_t>(fault.result)], fault.world, fault.step,
            fault.value};
  }

 private:
  // Those of the end of the step were taken before worlds began anew.
  void name_faults() {
    runner->take_faults(faults);
    if (faults.empty()) return;
    for (const Fault& fault : faults) {
      const auto is_same = [&](const Fault& f) { return f.result == fault.result; };
      if (std::none_of(named.begin(), named.end(), is_same)) named.push_back(fault);
    }
    if (!check_finite) return;
    throw NonFiniteError(describe(
        *std::min_element(faults.begin(), faults.end(), [](const Fault& a, const Fault& b) {
          return std::tie(a.world, a.result) < std::tie(b.world, b.result);
        })));
  }
  void tell_resets(const Batch::Impl& b, std::span<const std::uint8_t> mask) const {
    if (b.listeners.empty()) return;
    b.for_each_masked(mask, [&](int, int, int world) { b.tell(batch, Input::reset, world); });
  }
  void tell_step(const Batch::Impl& b, int steps, bool begins) const {
    if (b.listeners.empty()) return;
    const std::size_t n = begins ? task.controls.size() : 0;
    std::vector<double> values(worlds() * n);
    if (n > 0) batch.read_controls(values);
    for (std::size_t w = 0; n > 0 && w < worlds(); ++w) {
      // What froze the world has not become a control.
      if (runner->unsound[w]) values[w * n] = std::numeric_limits<double>::quiet_NaN();
      b.tell_controls(batch, static_cast<int>(w), std::span(values).subspan(w * n, n));
    }
    b.tell_step(batch, steps);
  }
  // The caller's arrays live as long as the call.
  void forget_call() {
    runner->out = {};
    runner->actions = nullptr;
    runner->choices = nullptr;
  }
};

}  // namespace manyworlds
