// What is wrong with a term of a task: what it is about does not exist.
#include <algorithm>
#include <cmath>
#include <string>

#include "src/api/observable.hpp"
#include "src/api/observer_results.hpp"
#include "src/plan/plan_data.hpp"
#include "src/scene/checks.hpp"
#include "src/scene/variations.hpp"
#include "src/task/check_task.hpp"
#include "src/task/node.hpp"

namespace manyworlds {

namespace {

class TermChecker {
 public:
  TermChecker(const Task& task, const Plan* plan, std::vector<Issue>& issues)
      : task_(task), plan_(plan), issues_(issues) {}

  void check(const std::string& place, const Expression& e) {
    const Expression::Node& n = e.node();
    const auto bounded = [&](int value, std::size_t count, const char* what) {
      if (value >= 0 && static_cast<std::size_t>(value) < count) return true;
      issues_.push_back({place, describe(e) + ": " + what + " must be 0 to " +
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
          issues_.push_back({place, describe(e) + ": the axis must be 2 in a planar scene"});
        } else {
          bounded(n.axis, 3, "the axis");
        }
        break;
      case Term::angle:
        body();
        if (!planar)
          issues_.push_back({place, describe(e) + ": angles exist in planar scenes only"});
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
              {place, describe(e) + ": " +
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
      case Term::level: check_named(place, "level", n.text, task_.levels, "Task::levels"); break;
      case Term::memory:
        check_named(place, "memory", n.text, task_.memories, "Task::memories");
        break;
      case Term::number:
        if (!std::isfinite(n.number)) {
          issues_.push_back(
              {place, "holds the number " + detail::number_text(n.number) + ", must be finite"});
        }
        break;
      default: break;
    }
  }

  template <class Named>
  void check_named(const std::string& place, const char* what, const std::string& name,
                   const std::vector<Named>& all, const char* list) {
    const auto is_it = [&name](const Named& one) { return one.name == name; };
    if (std::any_of(all.begin(), all.end(), is_it)) return;
    std::string there;
    for (const Named& one : all) there += (there.empty() ? "" : ", ") + one.name;
    issues_.push_back({place, std::string("uses the ") + what + " '" + name + "', must be one of " +
                                  list + (there.empty() ? ", which is empty" : ": " + there)});
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
    issues_.push_back({place, describe(e) + ": this parameter cannot vary"});
  }

  template <class Bounded>
  void check_observed(const std::string& place, const Expression& e, const Bounded& bounded) {
    const Expression::Node& n = e.node();
    const ObservedInfo& what = *observed_by(n);
    const Scene& scene = task_.scene;
    if (!observable(what.observer, scene)) {
      issues_.push_back(
          {place, describe(e) + ": " + why_not_observable(static_cast<Observed>(n.of), scene)});
      return;
    }
    const auto item = static_cast<std::size_t>(n.index);
    switch (info(what.observer).item) {
      case ObservedItem::world: bounded(n.index, 1, "the item"); break;
      case ObservedItem::body:
        if (bounded(n.index, scene.bodies.size(), "the body") &&
            scene.bodies[item].motion == Motion::fixed) {
          const bool touch = what.observer == Observer::touching;
          issues_.push_back({place, describe(e) + ": a fixed body is not observed" +
                                        (touch ? ", observe the bodies that touch it" : "")});
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
        issues_.push_back({place, describe(e) + ": the axis must be 2 in a planar scene"});
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
    issues_.push_back(
        {place, describe(e) +
                    ": its centre of mass varies between worlds, must be at the frame's origin"});
  }

 private:
  const Task& task_;
  const Plan* plan_;
  std::vector<Issue>& issues_;
};

}  // namespace

void check_term(const Task& task, const Plan* plan, const std::string& place,
                const Expression& term, std::vector<Issue>& issues) {
  TermChecker(task, plan, issues).check(place, term);
}

}  // namespace manyworlds
