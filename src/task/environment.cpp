// The public Environment: checks what a caller gives, and hands over.
#include "manyworlds/environment.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "manyworlds/expression_graph.hpp"
#include "src/base/enum_names.hpp"
#include "src/scene/checks.hpp"
#include "src/task/check_task.hpp"
#include "src/task/environment_data.hpp"

namespace manyworlds {

const char* to_string(Autoreset autoreset) { return name_of(autoreset); }

std::string to_string(const NonFinite& fault) {
  return fault.expression + " is " + detail::number_text(fault.value) + " in world " +
         std::to_string(fault.world) +
         (fault.step == 0 ? " at the start of its episode"
                          : " at step " + std::to_string(fault.step) + " of its episode");
}

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
  for (int i = 0; i < kObserverCount; ++i) {
    if (programs.after.asks(Observer(i))) out.observe.what.push_back(Observer(i));
  }
  out.observe.rays = task.rays;
  out.observe.points = task.points;
  return out;
}

}  // namespace

Environment::Impl::Impl(const Task& t, const EnvironmentOptions& options)
    : task(checked(t)),
      autoreset(checked_enum(options.autoreset)),
      plan(compile(task.scene)),
      programs(std::make_shared<TaskPrograms>(task, plan)),
      batch(plan, options_of(task, *programs, options)),
      runner(make_runner(programs, batch, autoreset)),
      check_finite(options.check) {
  faults.reserve(2 * programs->results.size());
  named.reserve(programs->results.size());
}

Environment::Environment(const Task& task, const EnvironmentOptions& options)
    : impl_(Pimpl<Impl>::make(task, options)) {
  const std::vector<std::uint8_t> all(impl_->worlds(), 1);
  if (task.initial_parameters.empty()) {
    impl_->begin(*impl_->batch.impl_, all, {.first = true}, {});
  } else {  // once more, with them
    std::vector<std::uint64_t> seeds;
    for (std::size_t w = 0; w < all.size(); ++w) seeds.push_back(options.seed + w);
    reset(all, seeds, {});
  }
}
Environment::~Environment() = default;
Environment::Environment(Environment&&) noexcept = default;
Environment& Environment::operator=(Environment&&) noexcept = default;

const Task& Environment::task() const { return impl_->task; }
Autoreset Environment::autoreset() const { return impl_->autoreset; }
int Environment::worlds() const { return impl_->batch.worlds(); }
int Environment::observations() const { return static_cast<int>(impl_->task.observations.size()); }
int Environment::infos() const { return static_cast<int>(impl_->task.infos.size()); }
int Environment::actions() const { return impl_->programs->inputs.actions; }
int Environment::steps_left() const { return impl_->steps_left; }
Batch& Environment::batch() { return impl_->batch; }
const Batch& Environment::batch() const { return impl_->batch; }

void Environment::step(std::span<const float> actions, const StepArrays& out) {
  step(actions, out, {});
}
bool Environment::step(std::span<const float> actions, const StepArrays& out, const GoOn& go_on) {
  if (impl_->discrete()) reject("the task's actions are choices, these are numbers");
  check_array("actions", actions.size(), impl_->worlds() * impl_->task.actions.size(), false);
  impl_->check(out);
  impl_->check_between_steps("step");
  return impl_->step(actions.data(), out, go_on);
}

void Environment::step(std::span<const std::int64_t> actions, const StepArrays& out) {
  step(actions, out, {});
}
bool Environment::step(std::span<const std::int64_t> actions, const StepArrays& out,
                       const GoOn& go_on) {
  if (!impl_->discrete()) reject("the task's actions are numbers, these are choices");
  check_array("actions", actions.size(), impl_->worlds(), false);
  impl_->check(out);
  const int choices = impl_->task.choices;
  const auto none = [choices](std::int64_t a) { return a < 0 || a >= choices; };
  if (const auto bad = std::find_if(actions.begin(), actions.end(), none); bad != actions.end()) {
    reject("the action of world " + std::to_string(bad - actions.begin()) + " is " +
           std::to_string(*bad) + ", must be 0 to " + std::to_string(choices - 1));
  }
  impl_->check_between_steps("step");
  return impl_->step(actions.data(), out, go_on);
}

void Environment::finish_step(const StepArrays& out) { finish_step(out, {}); }
bool Environment::finish_step(const StepArrays& out, const GoOn& go_on) {
  if (steps_left() == 0) reject("finish_step: no step was interrupted");
  impl_->check(out);
  return impl_->finish_step(out, go_on);
}

void Environment::reset(std::span<const std::uint8_t> mask, const BeginArrays& out) {
  impl_->check_to_begin("reset", mask, out);
  impl_->begin(*impl_->batch.impl_, mask, {.resets = true}, out);
}
void Environment::reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds,
                        const BeginArrays& out) {
  impl_->check_to_begin("reset", mask, out);
  check_array("seeds", seeds.size(), impl_->worlds(), false);
  impl_->begin(*impl_->batch.impl_, mask, {.first = true, .resets = true, .seeds = seeds}, out);
}
void Environment::begin(std::span<const std::uint8_t> mask, const BeginArrays& out) {
  impl_->check_to_begin("begin", mask, out);
  impl_->begin(*impl_->batch.impl_, mask, {}, out);
}

std::vector<NonFinite> Environment::non_finite() const {
  std::vector<NonFinite> out;
  for (const Fault& fault : impl_->named) out.push_back(impl_->describe(fault));
  return out;
}
int Environment::non_finite_expressions() const { return static_cast<int>(impl_->named.size()); }

void Environment::evaluate(const Expression& expression, std::span<double> out) const {
  impl_->check_between_steps("evaluate");
  check_array("values", out.size(), impl_->worlds(), false);
  const auto issues = check_expression(impl_->task, impl_->plan, expression, "evaluate");
  if (!issues.empty()) reject(to_string(issues.front()));
  const TaskPrograms programs(impl_->task, impl_->plan, &expression);
  if (!programs.evaluated_is_known) {
    reject("evaluate: " + text_of(expression, 200) +
           " depends on earlier steps that the task does not store: add it to the task as an Info");
  }
  for (int i = 0; i < kObserverCount; ++i) {
    if (!programs.after.asks(Observer(i)) || impl_->programs->after.asks(Observer(i))) continue;
    reject("evaluate: " + text_of(expression, 200) + " depends on the observer '" +
           to_string(Observer(i)) +
           "', which the task does not use: add the expression to the task as an Info");
  }
  impl_->runner->evaluate(*impl_->batch.impl_->core, programs, out);
}

int Environment::levels() const { return static_cast<int>(impl_->task.levels.size()); }
void Environment::read_levels(std::span<double> out) const {
  const std::size_t n = impl_->task.levels.size();
  check_array("levels", out.size(), impl_->worlds() * n, false);
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = impl_->runner->level(static_cast<int>(i / n), i % n);
  }
}
void Environment::write_levels(std::span<const std::uint8_t> mask, std::span<const double> in) {
  const std::size_t n = impl_->task.levels.size();
  impl_->check_between_steps("write_levels");
  check_array("the mask's entries", mask.size(), impl_->worlds(), false);
  check_array("levels", in.size(), impl_->worlds() * n, false);
  const double max = batch().precision() == Precision::f32 ? std::numeric_limits<float>::max()
                                                           : std::numeric_limits<double>::max();
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (!mask[i / n] || std::abs(in[i]) <= max) continue;
    reject("the level '" + impl_->task.levels[i % n].name + "' of world " + std::to_string(i / n) +
           " is " + detail::number_text(in[i]) + ", must be a finite number of the batch's type");
  }
  for (std::size_t i = 0; i < in.size(); ++i) {
    if (mask[i / n]) impl_->runner->set_level(static_cast<int>(i / n), i % n, in[i]);
  }
}

void Environment::copy_world(int from, int to) {
  impl_->check_between_steps("copy_world");
  impl_->batch.copy_world(from, to);
  std::vector<double> numbers(impl_->runner->numbers());
  impl_->runner->save_world(from, numbers);
  impl_->runner->restore_world(to, numbers);
}

EnvironmentSnapshot Environment::save() const {
  impl_->check_between_steps("save");
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
  impl_->steps_left = 0;
  for (int w = 0; w < worlds(); ++w) impl_->runner->restore_world(w, impl_->memory(snapshot, w));
}

void Environment::restore(const EnvironmentSnapshot& snapshot, int from, int to) {
  impl_->check(snapshot);
  impl_->check_between_steps("restore of a world");
  impl_->batch.restore(snapshot.worlds, from, to);
  impl_->runner->restore_world(to, impl_->memory(snapshot, from));
}

}  // namespace manyworlds
