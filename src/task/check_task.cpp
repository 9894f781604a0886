// What is wrong with a task.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "manyworlds/plan.hpp"
#include "manyworlds/task.hpp"
#include "src/api/observable.hpp"
#include "src/api/observer_results.hpp"
#include "src/base/float_mode.hpp"
#include "src/plan/plan_data.hpp"
#include "src/scene/checks.hpp"
#include "src/scene/variations.hpp"
#include "src/task/node.hpp"

namespace manyworlds {

namespace {

std::string named(const char* what, std::size_t i, const std::string& name) {
  return std::string(what) + " " + std::to_string(i) + (name.empty() ? "" : " '" + name + "'");
}

// When an expression is worked out, which says what it may depend on.
enum class When {
  after_steps,
  before_steps,    // controls
  before_episode,  // initial parameters
  before_first,    // where levels begin
};

class TaskChecker {
 public:
  explicit TaskChecker(const Task& task) : task_(task), issues_(validate(task.scene)) {
    if (issues_.empty()) plan_.emplace(compile(task.scene));
  }

  std::vector<Issue> check() {
    if (task_.frame_skip < 1) add("frame_skip", "is ", task_.frame_skip, ", must be >= 1");
    if (task_.max_steps < 0) add("max_steps", "is ", task_.max_steps, ", must be >= 0");
    check_actions();
    const std::size_t controls = task_.scene.controls.size();
    if (task_.controls.size() != controls) {
      add("controls", "are ", task_.controls.size(),
          ", must be as many as the scene has: " + std::to_string(controls));
    }
    for (std::size_t i = 0; i < task_.controls.size(); ++i) {
      check(named("control", i, i < controls ? task_.scene.controls[i].name : ""),
            task_.controls[i], When::before_steps);
    }
    check_levels();
    check_initial_parameters();
    check_observations();
    for (std::size_t i = 0; i < task_.rewards.size(); ++i) {
      check(named("reward", i, task_.rewards[i].name), task_.rewards[i].value);
    }
    for (std::size_t i = 0; i < task_.infos.size(); ++i) {
      check(named("info", i, task_.infos[i].name), task_.infos[i].value);
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

  void check_actions() {
    if (task_.choices < 0) add("choices", "is ", task_.choices, ", must be >= 0");
    if (task_.choices > 0 && !task_.actions.empty()) {
      add("actions", "are ", task_.actions.size(), ", must be none where there are choices");
    }
    for (std::size_t i = 0; i < task_.actions.size(); ++i) {
      const Action& a = task_.actions[i];
      if (!std::isfinite(a.low) || !std::isfinite(a.high) || !(a.low < a.high)) {
        add_range(named("action", i, a.name), a.low, a.high, "must be finite and rising");
      }
    }
  }

  void check_observations() {
    if (task_.observations.empty()) issues_.push_back({"observations", "are none, must be some"});
    for (std::size_t i = 0; i < task_.observations.size(); ++i) {
      const Observation& o = task_.observations[i];
      const std::string place = named("observation", i, o.name);
      check(place, o.value);
      if (!(o.low <= o.high)) add_range(place, o.low, o.high, "must rise");
    }
  }

  void check_levels() {
    std::set<std::string> names;
    for (std::size_t i = 0; i < task_.levels.size(); ++i) {
      const Level& level = task_.levels[i];
      const std::string place = named("level", i, level.name);
      if (level.name.empty()) issues_.push_back({place, "has no name, must have one"});
      if (!names.insert(level.name).second) {
        issues_.push_back({place, "has the name of one before it, must have its own"});
      }
      check(place + ", begin", level.begin, When::before_first);
      if (level.next) check(place + ", next", *level.next);
    }
  }

  void check_initial_parameters() {
    std::set<std::ptrdiff_t> set;  // which of the numbers that vary
    for (std::size_t i = 0; i < task_.initial_parameters.size(); ++i) {
      const InitialParameter& s = task_.initial_parameters[i];
      const std::string place = named("initial parameter", i, "");
      check(place + ", value", s.value, When::before_episode);
      if (s.parameter.node().term != Term::parameter) {
        issues_.push_back({place, "is of " + to_string(s.parameter) +
                                      ", must be of a parameter (terms::parameter)"});
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
      const std::string is = "is of " + to_string(s.parameter) + ", which ";
      if (at == varied.end()) {
        issues_.push_back({place, is + "does not vary (Scene::variations)"});
      } else if (task_.scene.variations[static_cast<std::size_t>(at->variation)].draw !=
                 Draw::none) {
        issues_.push_back({place, is + "is drawn, must vary with Draw::none"});
      } else if (!set.insert(at - varied.begin()).second) {
        issues_.push_back({place, is + "another one sets"});
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
    const bool looks_back = n.term == Term::arithmetic && remembers(n.operation);
    if (!fits(n, when)) {
      issues_.push_back({place, "depends on " + (looks_back ? "what is remembered" : to_string(e)) +
                                    ", must depend on " + wanted(when)});
      return;
    }
    check_leaf(place, e);
    for (const Expression& operand : n.operands) {
      walk(place, operand, looks_back ? When::after_steps : when);
    }
  }

  static bool fits(const Expression::Node& n, When when) {
    if (when == When::after_steps) return true;
    const bool remembered = n.term == Term::arithmetic && remembers(n.operation);
    switch (n.term) {
      case Term::number:
      case Term::function: return true;
      case Term::arithmetic:
        return !remembered ||
               (when == When::before_steps && n.operation == kernels::Operation::previous);
      case Term::uniform:
        return when == When::before_steps || static_cast<Every>(n.of) == Every::episode;
      case Term::level: return when != When::before_first;
      case Term::action:
      case Term::parameter: return when == When::before_steps;
      default: return false;
    }
  }
  static const char* wanted(When when) {
    switch (when) {
      case When::before_steps:
        return "actions, numbers, random ones, parameters, levels and previous(...) alone";
      case When::before_episode: return "numbers, random ones of the episode and levels alone";
      default: return "numbers and random ones of the episode alone";
    }
  }

  void check_leaf(const std::string& place, const Expression& e) {
    const Expression::Node& n = e.node();
    const auto bounded = [&](int value, std::size_t count, const char* what) {
      if (value >= 0 && static_cast<std::size_t>(value) < count) return true;
      issues_.push_back({place, to_string(e) + ": " + what + " must be 0 to " +
                                    std::to_string(count == 0 ? 0 : count - 1) +
                                    (count == 0 ? ", but there are none" : "")});
      return false;
    };
    const bool planar = task_.scene.space == Space::planar;
    const auto axis = [&](int value) {
      bounded(value, planar && n.term != Term::direction ? 2 : 3, "the axis");
    };
    const auto body = [&] { return bounded(n.index, task_.scene.bodies.size(), "the body"); };
    switch (n.term) {
      case Term::position:
        axis(n.axis);
        if (body()) check_center(place, e);
        break;
      case Term::velocity:
        axis(n.axis);
        body();
        break;
      case Term::angular_velocity:
        body();
        if (planar && n.axis != 2) {
          issues_.push_back({place, to_string(e) + ": the axis must be 2 in the plane"});
        } else {
          bounded(n.axis, 3, "the axis");
        }
        break;
      case Term::angle:
        body();
        if (!planar)
          issues_.push_back({place, to_string(e) + ": there are angles in the plane only"});
        break;
      case Term::direction:
        axis(n.axis);
        axis(n.of);
        body();
        break;
      case Term::generalized_position:
      case Term::generalized_velocity:
        if (task_.scene.options.solver.method != Solver::newton) {
          const bool speed = n.term == Term::generalized_velocity;
          issues_.push_back(
              {place, to_string(e) + ": " +
                          needs_newton(task_.scene, speed ? "joint_speed of a joint or velocity of "
                                                            "a body"
                                                          : "joint_position of a joint or position "
                                                            "of a body")});
        } else if (plan_) {
          const bool velocity = n.term == Term::generalized_velocity;
          const ItemKind of = velocity ? ItemKind::dof : ItemKind::coordinate;
          bounded(n.index, static_cast<std::size_t>(plan_->items(of)),
                  velocity ? "the degree of freedom" : "the coordinate");
        }
        break;
      case Term::observed: check_observed(place, e, bounded); break;
      case Term::action:
        bounded(n.index, task_.choices > 0 ? 1 : task_.actions.size(), "the action");
        break;
      case Term::control: bounded(n.index, task_.scene.controls.size(), "the control"); break;
      case Term::uniform:
        if (n.text.empty())
          issues_.push_back({place, "a random number has no name, must have one"});
        bounded(n.index, 2, "the number");
        break;
      case Term::parameter: check_parameter(place, e, bounded); break;
      case Term::level: check_level(place, n.text); break;
      default: break;
    }
  }

  void check_level(const std::string& place, const std::string& name) {
    const auto is = [&name](const Level& level) { return level.name == name; };
    if (std::any_of(task_.levels.begin(), task_.levels.end(), is)) return;
    std::string there;
    for (const Level& level : task_.levels) there += (there.empty() ? "" : ", ") + level.name;
    issues_.push_back({place, "asks for the level '" + name + "', must be one of Task::levels" +
                                  (there.empty() ? ", of which there are none" : ": " + there)});
  }

  template <class Bounded>
  void check_parameter(const std::string& place, const Expression& e, const Bounded& bounded) {
    const Expression::Node& n = e.node();
    const Scene& scene = task_.scene;
    const auto parameter = static_cast<Parameter>(n.of);
    const std::size_t count = static_cast<std::size_t>(info(parameter).numbers);
    bool found = bounded(n.axis, count, "the number");
    switch (info(parameter).owner) {
      case ParameterInfo::world: break;
      case ParameterInfo::shape:
      case ParameterInfo::body:
        found = bounded(n.index, scene.bodies.size(), "the body") && found;
        if (!found || info(parameter).owner == ParameterInfo::body) break;
        found = bounded(n.shape, scene.at(BodyId(n.index)).shapes.size(), "the shape");
        break;
      case ParameterInfo::joint:
        found = bounded(n.index, scene.joints.size(), "the joint") && found;
        break;
      case ParameterInfo::control:
        found = bounded(n.index, scene.controls.size(), "the control") && found;
        break;
      case ParameterInfo::attractor:
        found = bounded(n.index, scene.attractors.size(), "the attractor") && found;
        break;
    }
    if (!found || can_vary(scene, parameter, owner_of(n))) return;
    issues_.push_back({place, to_string(e) + ": there is no such number that could vary"});
  }

  template <class Bounded>
  void check_observed(const std::string& place, const Expression& e, const Bounded& bounded) {
    const Expression::Node& n = e.node();
    const ObservedInfo& what = *observed_by(n);
    const Scene& scene = task_.scene;
    if (!observable(what.observer, scene)) {
      issues_.push_back(
          {place, to_string(e) + ": " + why_not_observable(static_cast<Observed>(n.of), scene)});
      return;
    }
    const auto item = static_cast<std::size_t>(n.index);
    switch (info(what.observer).item) {
      case ObservedItem::world: bounded(n.index, 1, "the item"); break;
      case ObservedItem::body:
        if (bounded(n.index, scene.bodies.size(), "the body") &&
            scene.bodies[item].motion == Motion::fixed) {
          const bool touch = what.observer == Observer::touching;
          issues_.push_back({place, to_string(e) + ": a fixed body is not observed" +
                                        (touch ? ", ask those that touch it" : "")});
        }
        break;
      case ObservedItem::joint: bounded(n.index, scene.joints.size(), "the joint"); break;
      case ObservedItem::coordinate: {
        if (!bounded(n.index, scene.joints.size(), "the joint") || !plan_) return;
        const auto& first = plan_->data().first_observed;
        bounded(n.axis, static_cast<std::size_t>(first[item + 1] - first[item]), "the coordinate");
        return;
      }
      case ObservedItem::dof:
        if (plan_) {
          bounded(n.index, static_cast<std::size_t>(plan_->items(ItemKind::dof)),
                  "the degree of freedom");
        }
        break;
      case ObservedItem::tendon: bounded(n.index, scene.tendons.size(), "the tendon"); break;
      case ObservedItem::site: bounded(n.index, scene.sites.size(), "the site"); break;
      case ObservedItem::ray: bounded(n.index, task_.rays.size(), "the ray"); break;
      case ObservedItem::point: bounded(n.index, task_.points.size(), "the point"); break;
    }
    check_component(place, e, bounded);
  }
  template <class Bounded>
  void check_component(const std::string& place, const Expression& e, const Bounded& bounded) {
    const Expression::Node& n = e.node();
    const bool spin = observed_by(n)->components == ObservedComponents::spin;
    if (spin && task_.scene.space == Space::planar) {
      if (n.axis != 2)
        issues_.push_back({place, to_string(e) + ": the axis must be 2 in the plane"});
      return;
    }
    const int count = components(static_cast<Observed>(n.of), task_.scene.space);
    bounded(n.axis, static_cast<std::size_t>(count), "the axis");
  }

  // A body frame that moves against its centre of mass from world to world is not to be had.
  void check_center(const std::string& place, const Expression& e) {
    if (!plan_) return;
    const auto row = plan_->find_row(BodyId(e.node().index));
    if (!row) return;
    const PlanBody& b = plan_->data().bodies[static_cast<std::size_t>(*row)];
    if (!b.reshaped || b.aligned) return;
    issues_.push_back({place, to_string(e) + ": its centre of mass varies from world to world, "
                                             "must be where its frame is"});
  }

  const Task& task_;
  std::vector<Issue> issues_;
  std::optional<Plan> plan_;
  std::set<std::pair<const Expression::Node*, When>> seen_;
};

}  // namespace

std::vector<Issue> validate(const Task& task) {
  const FloatMode mode;
  return TaskChecker(task).check();
}

}  // namespace manyworlds
