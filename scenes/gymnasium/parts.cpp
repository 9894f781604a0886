#include "scenes/gymnasium/parts.hpp"

#include <algorithm>
#include <stdexcept>

#include "manyworlds/batch.hpp"

namespace manyworlds::gymnasium {

Expression sum(const std::vector<Expression>& all) {
  Expression out = all.empty() ? Expression(0) : all.front();
  for (std::size_t i = 1; i < all.size(); ++i) out = out + all[i];
  return out;
}

Expression norm(const std::vector<Expression>& v) {
  std::vector<Expression> squares;
  for (const Expression& x : v) squares.push_back(square(x));
  return sqrt(sum(squares));
}

namespace {

// In the most digits that there are: a build may have the kernels of one precision alone.
Batch one_world(const Plan& plan) {
  try {
    return Batch(plan, {.worlds = 1, .threads = 1, .precision = Precision::f64});
  } catch (const std::invalid_argument&) {
    return Batch(plan, {.worlds = 1, .threads = 1, .precision = Precision::f32});
  }
}

}  // namespace

TaskOf::TaskOf(const Scene& model, int frame_skip, const Wanted& wanted) {
  task.name = wanted.name;
  task.scene = model;
  task.frame_skip = frame_skip;
  task.max_steps = wanted.max_steps;
  task.solved_at = wanted.solved_at;
  if (model.options.solver.method != Solver::newton) {
    refuse("is not one of joints for Solver::newton");
  }
  task.scene.coordinate_draws.clear();
  const Batch batch = one_world(compile(task.scene));
  start_.resize(batch.size(Field::generalized_position));
  batch.read(Field::generalized_position, std::span<double>(start_));
  coordinates_ = static_cast<int>(start_.size());
  dofs_ = static_cast<int>(batch.size(Field::generalized_velocity));
  const auto check = [&](const char* what, int found, int expected) {
    if (expected < 0 || found == expected) return;
    refuse("has " + std::to_string(found) + " " + what + ", must have " + std::to_string(expected));
  };
  check("coordinates", coordinates_, wanted.coordinates);
  check("degrees of freedom", dofs_, wanted.dofs);
  check("controls", static_cast<int>(model.controls.size()), wanted.controls);
  if (coordinates_ < wanted.least_coordinates) {
    refuse("has " + std::to_string(coordinates_) + " coordinates, must have " +
           std::to_string(wanted.least_coordinates) + " or more");
  }
  for (const Control& control : model.controls) {
    task.actions.push_back({control.name, control.low, control.high, false});
    task.controls.push_back(action(static_cast<int>(task.controls.size())));
  }
}

void TaskOf::refuse(const std::string& what) const {
  throw std::invalid_argument("the model '" + task.scene.name + "' for " + task.name + " " + what);
}

double TaskOf::start(int coordinate) const {
  return start_.at(static_cast<std::size_t>(coordinate));
}

BodyId TaskOf::body(const char* name) const { return task.scene.body(name); }

std::vector<BodyId> TaskOf::links() const {
  std::vector<BodyId> out;
  for (std::size_t i = 0; i < task.scene.bodies.size(); ++i) {
    if (task.scene.bodies[i].motion == Motion::dynamic) out.emplace_back(static_cast<int>(i));
  }
  return out;
}

BodyId TaskOf::link_of_mujoco(int body) const {
  const std::vector<BodyId> all = links();
  if (body >= 1 && static_cast<std::size_t>(body) <= all.size()) {
    return all[static_cast<std::size_t>(body) - 1];
  }
  refuse("has the bodies 1 to " + std::to_string(all.size()) + ", and " + std::to_string(body) +
         " is asked for");
}

SiteId TaskOf::first_site() const {
  if (task.scene.sites.empty()) refuse("has no site, must have one");
  return SiteId(0);
}

Expression TaskOf::sum_of_squares_of_actions() const {
  std::vector<Expression> squares;
  for (std::size_t i = 0; i < task.actions.size(); ++i) {
    squares.push_back(square(action(static_cast<int>(i))));
  }
  return sum(squares);
}

void TaskOf::observe(const std::string& name, const Expression& value) {
  task.observations.push_back({name, value});
}
void TaskOf::observe_positions(int first) {
  for (int i = first; i < coordinates_; ++i) observe("qpos " + std::to_string(i), qpos(i));
}
void TaskOf::observe_velocities(double limit) {
  for (int i = 0; i < dofs_; ++i) {
    const Expression v = limit < kInfinity ? clamp(qvel(i), -limit, limit) : qvel(i);
    observe("qvel " + std::to_string(i), v);
  }
}

void TaskOf::reward(const char* name, const Expression& value) {
  task.rewards.push_back({name, value});
  step_info(name, value);
}

void TaskOf::begin_with_noise(double scale, bool normal_velocities) {
  draw(false, 0, coordinates_, scale);
  draw(true, 0, dofs_, scale, normal_velocities);
}
void TaskOf::draw(bool velocity, int first, int count, double scale, bool normal) {
  if (scale == 0) return;
  CoordinateDraw draw;
  draw.velocity = velocity, draw.first = first, draw.normal = normal;
  draw.low.assign(static_cast<std::size_t>(count), -scale);
  draw.high.assign(static_cast<std::size_t>(count), scale);
  task.scene.coordinate_draws.push_back(std::move(draw));
}

void tell_x(TaskOf& t, const Expression& x_velocity) {
  t.info("x_position", qpos(0));
  t.step_info("x_velocity", x_velocity);
}
void tell_xy(TaskOf& t) {
  t.info("x_position", qpos(0));
  t.info("y_position", qpos(1));
  t.info("distance_from_origin", norm({qpos(0), qpos(1)}));
}
void tell_tendons(TaskOf& t) {
  const auto tell = [&](const std::string& name, const auto& term) {
    for (std::size_t i = 0; i < t.task.scene.tendons.size(); ++i) {
      const std::string element = name + "[" + std::to_string(i) + "]";
      t.info(element.c_str(), term(TendonId(static_cast<int>(i))));
    }
  };
  tell("tendon_length", tendon_length);
  tell("tendon_velocity", tendon_velocity);
}

}  // namespace manyworlds::gymnasium
