#include "src/task/check_task.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "src/api/observer_results.hpp"
#include "src/base/float_mode.hpp"
#include "src/plan/plan_data.hpp"
#include "src/scene/checks.hpp"
#include "src/scene/variations.hpp"
#include "src/task/node.hpp"

namespace manyworlds {

namespace {

// When an expression is worked out, which says what it may depend on.
enum class When {
  after_steps,
  at_beginning,    // where memories begin
  before_steps,    // controls
  before_update,   // within functions of all steps there
  before_episode,  // initial parameters
  before_first,    // where levels begin
};

class TaskChecker {
 public:
  explicit TaskChecker(const Task& task) : task_(task), issues_(validate(task.scene)) {
    if (issues_.empty()) plan_.emplace(compile(task.scene));
  }
  TaskChecker(const Task& task, const Plan& plan) : task_(task), plan_(plan) {}

  std::vector<Issue> check_one(const std::string& place, const Expression& expression) {
    check(place, expression);
    return std::move(issues_);
  }

  std::vector<Issue> check() {
    if (task_.frame_skip < 1) add("frame_skip", "is ", task_.frame_skip, ", must be >= 1");
    if (task_.max_steps < 0) add("max_steps", "is ", task_.max_steps, ", must be >= 0");
    check_actions();
    const std::size_t controls = task_.scene.controls.size();
    if (task_.controls.size() != controls) {
      add("controls", "are ", task_.controls.size(),
          ", must match the scene's controls: " + std::to_string(controls));
    }
    for (std::size_t i = 0; i < task_.controls.size(); ++i) {
      check(place_of("control", i, i < controls ? task_.scene.controls[i].name : ""),
            task_.controls[i], When::before_steps);
    }
    check_levels();
    check_memories();
    check_initial_parameters();
    check_observations();
    check_names("reward", task_.rewards);
    for (std::size_t i = 0; i < task_.rewards.size(); ++i) {
      check(place_of("reward", i, task_.rewards[i].name), task_.rewards[i].value);
    }
    check_names("info", task_.infos);
    for (std::size_t i = 0; i < task_.infos.size(); ++i) {
      check(place_of("info", i, task_.infos[i].name), task_.infos[i].value);
    }
    check("terminated", task_.terminated);
    check("truncated", task_.truncated);
    check_list("rays", [&] { check_rays(task_.rays, *plan_); });
    check_list("points", [&] { check_points(task_.points, *plan_); });
    return std::move(issues_);
  }

 private:
  template <class Number>
  void add(const std::string& place, const char* is, Number found, const std::string& wanted) {
    issues_.push_back({place, is + std::to_string(found) + wanted});
  }

  void add_range(const std::string& place, double low, double high, const char* wanted) {
    issues_.push_back({place, "has the range " + detail::number_text(low) + " to " +
                                  detail::number_text(high) + ", " + wanted});
  }

  template <class Check>
  void check_list(const char* list, Check check_all) {
    if (!plan_) return;
    try {
      check_all();
    } catch (const std::invalid_argument& error) {
      issues_.push_back({list, error.what()});
    }
  }

  // Names are refused twice. Several without a name are not.
  template <class Named>
  void check_names(const char* what, const std::vector<Named>& all) {
    std::map<std::string, std::size_t> first;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (all[i].name.empty()) continue;
      const auto [at, fresh] = first.emplace(all[i].name, i);
      if (fresh) continue;
      issues_.push_back(
          {place_of(what, i, all[i].name),
           "has the name of " + place_of(what, at->second, all[i].name) + ", must be unique"});
    }
  }

  void check_actions() {
    check_names("action", task_.actions);
    if (task_.choices < 0) add("choices", "is ", task_.choices, ", must be >= 0");
    if (task_.choices > 0 && !task_.actions.empty()) {
      add("actions", "are ", task_.actions.size(), ", must be none with choices");
    }
    for (std::size_t i = 0; i < task_.actions.size(); ++i) {
      const Action& a = task_.actions[i];
      if (!std::isfinite(a.low) || !std::isfinite(a.high) || !(a.low < a.high)) {
        add_range(place_of("action", i, a.name), a.low, a.high,
                  "must be finite and have low < high");
      }
    }
  }

  void check_observations() {
    check_names("observation", task_.observations);
    if (task_.observations.empty())
      issues_.push_back({"observations", "are empty, must have at least one"});
    for (std::size_t i = 0; i < task_.observations.size(); ++i) {
      const Observation& o = task_.observations[i];
      const std::string place = place_of("observation", i, o.name);
      check(place, o.value);
      if (!(o.low <= o.high)) add_range(place, o.low, o.high, "must have low <= high");
    }
  }

  void check_levels() {
    check_names("level", task_.levels);
    for (std::size_t i = 0; i < task_.levels.size(); ++i) {
      const Level& level = task_.levels[i];
      const std::string place = place_of("level", i, level.name);
      if (level.name.empty()) issues_.push_back({place, "has no name, must have one"});
      check(place + ", begin", level.begin, When::before_first);
      if (level.next) check(place + ", next", *level.next);
    }
  }

  void check_memories() {
    check_names("memory", task_.memories);
    for (std::size_t i = 0; i < task_.memories.size(); ++i) {
      const Memory& memory = task_.memories[i];
      const std::string place = place_of("memory", i, memory.name);
      if (memory.name.empty()) issues_.push_back({place, "has no name, must have one"});
      check(place + ", begin", memory.begin, When::at_beginning);
      if (memory.next) check(place + ", next", *memory.next);
    }
  }

  void check_initial_parameters() {
    std::set<std::ptrdiff_t> set;  // which of the numbers that vary
    for (std::size_t i = 0; i < task_.initial_parameters.size(); ++i) {
      const InitialParameter& s = task_.initial_parameters[i];
      const std::string place = place_of("initial parameter", i, "");
      check(place + ", value", s.value, When::before_episode);
      if (s.parameter.node().term != Term::parameter) {
        issues_.push_back(
            {place, "sets " + describe(s.parameter) + ", must set a parameter (terms::parameter)"});
        continue;
      }
      const std::size_t before = issues_.size();
      check(place, s.parameter);
      if (issues_.size() > before || !plan_) continue;
      const NumberOwner of = owner_of(s.parameter.node());
      const auto& varied = plan_->data().varied;
      const auto at = std::find_if(varied.begin(), varied.end(), [&](const VariedNumber& v) {
        return v.parameter == static_cast<Parameter>(s.parameter.node().of) && v.of == of &&
               v.component == s.parameter.node().axis;
      });
      const std::string is = "sets " + describe(s.parameter) + ", which ";
      if (at == varied.end()) {
        issues_.push_back({place, is + "does not vary (Scene::variations)"});
      } else if (task_.scene.variations[static_cast<std::size_t>(at->variation)].draw !=
                 Draw::none) {
        issues_.push_back({place, is + "is drawn, must vary with Draw::none"});
      } else if (!set.insert(at - varied.begin()).second) {
        issues_.push_back({place, is + "another initial parameter sets"});
      }
    }
  }

  void check(const std::string& place, const Expression& e, When when = When::after_steps) {
    seen_.clear();
    walk(place, e, when);
  }
  void walk(const std::string& place, const Expression& e, When when) {
    const Expression::Node& n = e.node();
    // What previous(...) may look at, a control by itself may not.
    if (!seen_.emplace(&n, when).second) return;
    if (!fits(n, when)) {
      issues_.push_back({place, "depends on " + describe(e) + ", must depend on " + wanted(when)});
      return;
    }
    check_term(task_, plan_ ? &*plan_ : nullptr, place, e, issues_);
    const bool before = when == When::before_steps || when == When::before_update;
    When within = when;
    if (before && is(n, kernels::Operation::previous)) within = When::after_steps;
    if (before && n.term == Term::arithmetic && accumulates(n.operation)) {
      within = When::before_update;
    }
    for (const Expression& operand : n.operands) walk(place, operand, within);
  }

  static bool is(const Expression::Node& n, kernels::Operation operation) {
    return n.term == Term::arithmetic && n.operation == operation;
  }
  static bool fits(const Expression::Node& n, When when) {
    if (when == When::after_steps) return true;
    if (when == When::at_beginning) return n.term != Term::memory;
    const bool before_steps = when == When::before_steps || when == When::before_update;
    switch (n.term) {
      case Term::number:
      case Term::time_step:
      case Term::function: return true;
      case Term::arithmetic:
        return before_steps || !(accumulates(n.operation) || is(n, kernels::Operation::previous));
      case Term::uniform: return before_steps || static_cast<Every>(n.of) == Every::episode;
      case Term::level: return when != When::before_first;
      case Term::memory: return when == When::before_steps;
      case Term::action:
      case Term::age:
      case Term::parameter: return before_steps;
      default: return false;
    }
  }
  static const char* wanted(When when) {
    switch (when) {
      case When::before_steps:
        return "actions, constants, random numbers, parameters, levels, memories, age() and "
               "previous(...) only";
      case When::before_update:
        return "actions, constants, random numbers, parameters, levels, age() and previous(...) "
               "only";
      case When::at_beginning: return "terms other than memories";
      case When::before_episode: return "constants, random numbers of the episode and levels only";
      default: return "constants and random numbers of the episode only";
    }
  }

  const Task& task_;
  std::vector<Issue> issues_;
  std::optional<Plan> plan_;
  std::set<std::pair<const Expression::Node*, When>> seen_;
};

}  // namespace

std::string place_of(const char* what, std::size_t index, const std::string& name) {
  return std::string(what) + " " + std::to_string(index) + (name.empty() ? "" : " '" + name + "'");
}

std::vector<Issue> validate(const Task& task) {
  const FloatMode mode;
  return TaskChecker(task).check();
}

std::vector<Issue> check_expression(const Task& task, const Plan& plan,
                                    const Expression& expression, const std::string& place) {
  const FloatMode mode;
  return TaskChecker(task, plan).check_one(place, expression);
}

}  // namespace manyworlds
