// What Gymnasium's tasks have in common: a task of a model, and expressions in MuJoCo's words.
#pragma once

#include <cmath>
#include <initializer_list>
#include <string>
#include <vector>

#include "manyworlds/gymnasium.hpp"
#include "manyworlds/plan.hpp"

namespace manyworlds::gymnasium {

using namespace terms;

inline Expression qpos(int coordinate) { return generalized_position(coordinate); }
inline Expression qvel(int dof) { return generalized_velocity(dof); }
// An infinite end of a range is no bound: expressions hold finite numbers only.
inline Expression within(const Expression& x, const Range& range) {
  Expression inside = 1;
  if (std::isfinite(range[0])) inside = range[0] < x;
  if (!std::isfinite(range[1])) return inside;
  return std::isfinite(range[0]) ? inside & (x < range[1]) : x < range[1];
}
inline Expression within_or_at(const Expression& x, const Range& range) {
  Expression inside = 1;
  if (std::isfinite(range[0])) inside = range[0] <= x;
  if (!std::isfinite(range[1])) return inside;
  return std::isfinite(range[0]) ? inside & (x <= range[1]) : x <= range[1];
}
Expression sum(const std::vector<Expression>& all);
// Of the norm's three numbers, or of as many as there are.
Expression norm(const std::vector<Expression>& v);

// A task of a model: its actions are the model's controls, one each.
class TaskOf {
 public:
  // Throws std::invalid_argument for a model without trees, or with other numbers of coordinates,
  // dofs or controls; -1: any.
  struct Wanted {
    const char* name;  // of the task
    int coordinates = -1, dofs = -1, controls = -1;
    int least_coordinates = 0;
    int max_steps = 1000;
    double solved_at = kInfinity;
  };
  TaskOf(const Scene& model, int frame_skip, const Wanted& wanted);

  Task task;

  int coordinates() const { return coordinates_; }
  int dofs() const { return dofs_; }
  double dt() const { return task.scene.options.dt * task.frame_skip; }  // s
  double start(int coordinate) const;  // what the model begins with
  BodyId body(const char* name) const;
  // Those that move, in MuJoCo's order.
  std::vector<BodyId> links() const;
  // The one that is MuJoCo's body of this index, where 0 is the world.
  BodyId link_of_mujoco(int body) const;

  SiteId first_site() const;  // throws as above where the model has none

  // The change of x in a step, in a second; 0 at the beginning.
  Expression rate(const Expression& x) const { return (x - previous(x)) / dt(); }
  Expression sum_of_squares_of_actions() const;

  void observe(const std::string& name, const Expression& value);
  void observe_positions(int first);
  void observe_velocities(double limit = kInfinity);
  // A part of the reward, which is an info of the same name.
  void reward(const char* name, const Expression& value);
  void info(const char* name, const Expression& value) { task.infos.push_back({name, value}); }
  void step_info(const char* name, const Expression& value) {
    task.infos.push_back({name, value, true});
  }

  // What worlds begin with: uniform noise of all positions, and of all velocities, or normal.
  void begin_with_noise(double scale, bool normal_velocities = false);
  void draw(bool velocity, int first, int count, double scale, bool normal = false);

 private:
  [[noreturn]] void refuse(const std::string& what) const;

  int coordinates_ = 0, dofs_ = 0;
  std::vector<double> start_;
};

// Infos of x, and of x and y.
void tell_x(TaskOf& t, const Expression& x_velocity);
void tell_xy(TaskOf& t);  // and how far that is
void tell_tendons(TaskOf& t);

}  // namespace manyworlds::gymnasium
