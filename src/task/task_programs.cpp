// The programs of a task, and the fingerprint of all that they depend on.
#include <array>
#include <limits>

#include "src/base/hash.hpp"
#include "src/plan/plan_data.hpp"
#include "src/task/check_task.hpp"
#include "src/task/runner.hpp"

namespace manyworlds {

namespace {

std::uint64_t fingerprint_of(const Task& task, const TaskPrograms& programs, const Plan& plan) {
  Hasher hash;
  const auto add = [&hash](auto... numbers) {
    (hash.add(static_cast<std::uint64_t>(numbers)), ...);
  };
  const auto add_all = [&](const auto& numbers) {
    add(numbers.size());
    for (const auto number : numbers) hash.add(static_cast<double>(number));
  };
  add(plan.fingerprint(), task.frame_skip, task.choices, programs.max_steps, programs.terminated,
      programs.truncated, task.rays.size(), task.points.size());
  for (const Ray& ray : task.rays) {
    add_all(ray.origin);
    add_all(ray.direction);
    add(ray.body ? plan.row(ray.body) : -1, ray.mask);
    hash.add(ray.length);
  }
  for (const Point& point : task.points) {
    add_all(point.position);
    add(plan.row(point.body));
  }
  for (const auto* ranges : {&programs.action_range, &programs.control_range}) {
    add(ranges->size());
    for (const auto& range : *ranges) add_all(range);
  }
  for (const Program* program : {&programs.opening, &programs.before, &programs.after}) {
    add(program->instructions.size(), program->calls.size());
    for (const auto& i : program->instructions) {
      add(i.operation, i.a, i.b, i.c);
      hash.add(i.number);
    }
    for (const Program::Call& call : program->calls) {
      add(call.at);
      add_all(call.in);
    }
  }
  for (const auto* numbers : {&programs.inputs.numbers, &programs.initial_parameters}) {
    for (const HostNumber& n : *numbers) add(n.kind, n.stream, n.count, n.of, n.item);
  }
  for (const auto* rows :
       {&programs.controls, &programs.observations, &programs.rewards, &programs.memory.row,
        &programs.level_begins, &programs.level_nexts, &programs.initial_values}) {
    add_all(*rows);
  }
  return hash.value();
}

}  // namespace

TaskPrograms::TaskPrograms(const Task& task, const Plan& plan, const Expression* extra)
    : max_steps(task.max_steps) {
  inputs.actions = task.choices > 0 ? 1 : static_cast<int>(task.actions.size());
  for (const Action& a : task.actions) {
    constexpr double kAny = std::numeric_limits<double>::infinity();
    action_range.push_back(a.clamped ? std::array{a.low, a.high} : std::array{-kAny, kAny});
  }
  control_range = plan.data().control_range;
  ranges_vary = plan.data().varies.ranges;
  for (const Level& level : task.levels) inputs.levels.push_back(level.name);
  ProgramBuilder start(plan, task, inputs, memory);
  for (const Level& level : task.levels) level_begins.push_back(start.add(level.begin));
  for (const InitialParameter& s : task.initial_parameters) {
    initial_parameters.push_back(start.number_of(s.parameter.node()));
    initial_values.push_back(start.add(s.value));
  }
  opening = start.take();
  ProgramBuilder builder(plan, task, inputs, memory);
  for (const Observation& o : task.observations) observations.push_back(builder.add(o.value));
  for (const Reward& r : task.rewards) rewards.push_back(builder.add(r.value));
  for (const Info& i : task.infos) infos.push_back(builder.add(i.value));
  for (const Level& level : task.levels) {
    level_nexts.push_back(builder.add(level.next.value_or(terms::level(level.name))));
  }
  terminated = builder.add(task.terminated);
  truncated = builder.add(task.truncated | terms::lost());
  for (const Memory& m : task.memories) builder.add(terms::memory(m.name));
  name_results(task, builder);
  ProgramBuilder first(plan, task, inputs, memory, &builder);
  for (const Expression& c : task.controls) controls.push_back(first.add(c));
  before = first.take();
  if (extra) {
    const std::size_t remembered = memory.row.size();
    evaluated = builder.add(*extra);
    evaluated_is_known = memory.row.size() == remembered;
  }
  after = builder.take();
  fingerprint = fingerprint_of(task, *this, plan);
}

void TaskPrograms::name_results(const Task& task, ProgramBuilder& builder) {
  const auto add_all = [this](const char* what, const auto& all, const std::vector<int>& rows) {
    for (std::size_t i = 0; i < rows.size(); ++i) {
      results.push_back(rows[i]);
      result_names.push_back(place_of(what, i, all[i].name));
    }
  };
  add_all("observation", task.observations, observations);
  add_all("reward", task.rewards, rewards);
  results.push_back(terminated);
  result_names.emplace_back("terminated");
  results.push_back(builder.add(task.truncated));
  result_names.emplace_back("truncated");
}

}  // namespace manyworlds
