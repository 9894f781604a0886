// Environment: checks what a caller gives, and calls batch and runner in their order.
#include "manyworlds/environment.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "src/api/batch_data.hpp"
#include "src/base/enum_names.hpp"
#include "src/task/runner.hpp"

namespace manyworlds {

const char* to_string(Autoreset autoreset) { return name_of(autoreset); }

namespace {

Task checked(const Task& task) {
  std::vector<Issue> issues = validate(task);
  if (!issues.empty()) throw SceneError("task", std::move(issues));
  return task;
}

BatchOptions options_of(const Task& task, const TaskPrograms& programs,
                        const EnvironmentOptions& o) {
  BatchOptions out;
  out.worlds = o.worlds;
  out.threads = o.threads;
  out.seed = o.seed;
  out.precision = o.precision;
  out.isa = o.isa;
  out.executor = o.executor;
  const auto looks_at = [&](kernels::Operation what, Observer observer) {
    if (programs.after.has(what)) out.observe.what.push_back(observer);
  };
  looks_at(kernels::Operation::coordinate, Observer::joints);
  looks_at(kernels::Operation::touching, Observer::touching);
  out.observe.rays = task.rays;
  return out;
}

void check_array(const char* name, std::size_t found, std::size_t wanted, bool may_be_empty) {
  if (found == wanted || (found == 0 && may_be_empty)) return;
  reject(std::string(name) + " are " + std::to_string(wanted) + " numbers, the buffer has " +
         std::to_string(found));
}

}  // namespace

struct Environment::Impl {
  static constexpr const char* kName = "Environment";

  Task task;
  Autoreset autoreset;
  Plan plan;
  std::shared_ptr<const TaskPrograms> programs;
  Batch batch;
  std::unique_ptr<TaskRunner> runner;

  Impl(const Task& t, const EnvironmentOptions& options)
      : task(checked(t)),
        autoreset(checked_enum(options.autoreset)),
        plan(compile(task.scene)),
        programs(std::make_shared<TaskPrograms>(task, plan)),
        batch(plan, options_of(task, *programs, options)),
        runner(make_runner(programs, batch, autoreset)) {}

  std::size_t worlds() const { return static_cast<std::size_t>(batch.worlds()); }
  std::size_t observations() const { return worlds() * task.observations.size(); }
  bool discrete() const { return task.choices > 0; }

  void check(const StepArrays& out) const {
    check_array("observations", out.observations.size(), observations(), true);
    check_array("final_observations", out.final_observations.size(), observations(), true);
    if (out.observations.empty() && !out.final_observations.empty())
      reject("final_observations are wanted without observations");
    check_array("rewards", out.rewards.size(), worlds(), true);
    check_array("reward_terms", out.reward_terms.size(), worlds() * task.rewards.size(), true);
    check_array("terminated", out.terminated.size(), worlds(), true);
    check_array("truncated", out.truncated.size(), worlds(), true);
  }

  void check(const EnvironmentSnapshot& snapshot) const {
    if (snapshot.task != programs->fingerprint) {
      throw SnapshotError("snapshot: is of another task than '" + task.name + "'");
    }
    const std::size_t wanted =
        static_cast<std::size_t>(snapshot.worlds.worlds()) * runner->numbers();
    if (snapshot.memory.size() != wanted) {
      throw SnapshotError("snapshot: the task remembers " + std::to_string(snapshot.memory.size()) +
                          " numbers, must be " + std::to_string(wanted));
    }
  }
  std::span<const double> memory(const EnvironmentSnapshot& snapshot, int world) const {
    const std::size_t n = runner->numbers();
    return std::span(snapshot.memory).subspan(static_cast<std::size_t>(world) * n, n);
  }

  void step(Batch::Impl& b, const StepArrays& out) {
    runner->out = out;
    runner->some_begin = false;
    b.core->step(*b.executor, task.frame_skip, &runner->visitor());
    b.core->end_steps();
    b.steps += task.frame_skip;
    tell_step(b);
    if (runner->some_begin) {
      runner->keeps_last = autoreset == Autoreset::same_step;
      b.core->begin(*b.executor, runner->begin_now, true, runner->visitor());
      if (!b.listeners.empty()) {
        b.for_each_masked(runner->begin_now,
                          [&](int, int, int world) { b.tell(batch, Input::reset, world); });
      }
    }
    forget_call();
  }

  void begin(Batch::Impl& b, std::span<const std::uint8_t> mask, std::span<float> seen) {
    runner->out = {};
    runner->out.observations = seen;
    runner->keeps_last = false;
    b.core->begin(*b.executor, mask, false, runner->visitor());
    forget_call();
  }

 private:
  void tell_step(const Batch::Impl& b) const {
    if (b.listeners.empty()) return;
    const std::size_t n = task.controls.size();
    std::vector<double> values(worlds() * n);
    batch.read_controls(values);
    for (std::size_t w = 0; n > 0 && w < worlds(); ++w) {
      // What froze the world has not become a control.
      if (runner->unsound[w]) values[w * n] = std::numeric_limits<double>::quiet_NaN();
      b.tell_controls(batch, static_cast<int>(w), std::span(values).subspan(w * n, n));
    }
    b.tell_step(batch, task.frame_skip);
  }
  // The caller's arrays live as long as the call.
  void forget_call() {
    runner->out = {};
    runner->actions = nullptr;
    runner->choices = nullptr;
  }
};

Environment::Environment(const Task& task, const EnvironmentOptions& options)
    : impl_(Pimpl<Impl>::make(task, options)) {
  const std::vector<std::uint8_t> all(impl_->worlds(), 1);
  begin(all, {});
}
Environment::~Environment() = default;
Environment::Environment(Environment&&) noexcept = default;
Environment& Environment::operator=(Environment&&) noexcept = default;

const Task& Environment::task() const { return impl_->task; }
Autoreset Environment::autoreset() const { return impl_->autoreset; }
int Environment::worlds() const { return impl_->batch.worlds(); }
int Environment::observations() const { return static_cast<int>(impl_->task.observations.size()); }
int Environment::actions() const { return impl_->programs->inputs.actions; }
Batch& Environment::batch() { return impl_->batch; }
const Batch& Environment::batch() const { return impl_->batch; }

void Environment::step(std::span<const float> actions, const StepArrays& out) {
  if (impl_->discrete()) reject("the task's actions are choices, these are numbers");
  check_array("actions", actions.size(), impl_->worlds() * impl_->task.actions.size(), false);
  impl_->check(out);
  impl_->runner->actions = actions.data();
  impl_->step(*impl_->batch.impl_, out);
}

void Environment::step(std::span<const std::int64_t> actions, const StepArrays& out) {
  if (!impl_->discrete()) reject("the task's actions are numbers, these are choices");
  check_array("actions", actions.size(), impl_->worlds(), false);
  impl_->check(out);
  const int choices = impl_->task.choices;
  const auto none = [choices](std::int64_t a) { return a < 0 || a >= choices; };
  if (const auto bad = std::find_if(actions.begin(), actions.end(), none); bad != actions.end()) {
    reject("the action of world " + std::to_string(bad - actions.begin()) + " is " +
           std::to_string(*bad) + ", must be 0 to " + std::to_string(choices - 1));
  }
  impl_->runner->choices = actions.data();
  impl_->step(*impl_->batch.impl_, out);
}

void Environment::reset(std::span<const std::uint8_t> mask, std::span<float> observations) {
  check_array("observations", observations.size(), impl_->observations(), true);
  impl_->batch.reset(mask);
  begin(mask, observations);
}
void Environment::reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds,
                        std::span<float> observations) {
  check_array("observations", observations.size(), impl_->observations(), true);
  impl_->batch.reset(mask, seeds);
  begin(mask, observations);
}
void Environment::begin(std::span<const std::uint8_t> mask, std::span<float> observations) {
  check_array("the mask's entries", mask.size(), impl_->worlds(), false);
  check_array("observations", observations.size(), impl_->observations(), true);
  impl_->begin(*impl_->batch.impl_, mask, observations);
}

void Environment::copy_world(int from, int to) {
  impl_->batch.copy_world(from, to);
  std::vector<double> numbers(impl_->runner->numbers());
  impl_->runner->save_world(from, numbers);
  impl_->runner->restore_world(to, numbers);
}

EnvironmentSnapshot Environment::save() const {
  const std::size_t n = impl_->runner->numbers();
  EnvironmentSnapshot out{impl_->batch.save(), impl_->programs->fingerprint,
                          std::vector<double>(impl_->worlds() * n)};
  for (std::size_t w = 0; w < impl_->worlds(); ++w) {
    impl_->runner->save_world(static_cast<int>(w), std::span(out.memory).subspan(w * n, n));
  }
  return out;
}

void Environment::restore(const EnvironmentSnapshot& snapshot) {
  impl_->check(snapshot);
  impl_->batch.restore(snapshot.worlds);
  for (int w = 0; w < worlds(); ++w) impl_->runner->restore_world(w, impl_->memory(snapshot, w));
}

void Environment::restore(const EnvironmentSnapshot& snapshot, int from, int to) {
  impl_->check(snapshot);
  impl_->batch.restore(snapshot.worlds, from, to);
  impl_->runner->restore_world(to, impl_->memory(snapshot, from));
}

}  // namespace manyworlds
