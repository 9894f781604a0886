// Expression: a value per world that a task (task.hpp) computes after each of its steps, in SIMD
// lanes. Expressions combine terms of a world (namespace terms) by arithmetic, in the batch's
// precision. True is 1. Any value other than 0 counts as true.
//
//   const Expression lean = terms::angle(pole);
//   const Expression fallen = abs(lean) > 0.2;
//   const Expression reward = 1 - 0.1 * square(terms::position(cart, 0)) - 10 * fallen;
//
// The bits of a world are the same in any lane and batch, with any threads and instruction set.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/ids.hpp"
#include "manyworlds/observed.hpp"
#include "manyworlds/variation.hpp"

namespace manyworlds {

class LaneFunction;

class Expression {
 public:
  Expression(double number = 0);  // NOLINT(google-explicit-constructor): numbers are expressions

  struct Node;  // src/task/node.hpp
  // Throws std::invalid_argument for null. A moved-from Expression keeps its value.
  explicit Expression(std::shared_ptr<const Node> node);
  Expression(const Expression&) = default;
  Expression& operator=(const Expression&) = default;
  const Node& node() const { return *node_; }

 private:
  std::shared_ptr<const Node> node_;
};

// The whole expression in Python's syntax: "1 - 0.1 * (position(0, 'x') * position(0, 'x'))". In
// texts longer than 20,000 characters, deeply nested subexpressions are "...".
std::string to_string(const Expression& expression);

Expression operator+(const Expression& a, const Expression& b);
Expression operator-(const Expression& a, const Expression& b);
Expression operator*(const Expression& a, const Expression& b);
Expression operator/(const Expression& a, const Expression& b);
Expression operator-(const Expression& a);
Expression operator<(const Expression& a, const Expression& b);
Expression operator<=(const Expression& a, const Expression& b);
Expression operator>(const Expression& a, const Expression& b);
Expression operator>=(const Expression& a, const Expression& b);
Expression operator&(const Expression& a, const Expression& b);  // and
Expression operator|(const Expression& a, const Expression& b);  // or
Expression operator!(const Expression& a);
Expression equal(const Expression& a, const Expression& b);
Expression select(const Expression& condition, const Expression& yes, const Expression& no);

Expression abs(const Expression& a);
Expression square(const Expression& a);
Expression sqrt(const Expression& a);
Expression floor(const Expression& a);  // the largest integer <= a
Expression min(const Expression& a, const Expression& b);
Expression max(const Expression& a, const Expression& b);
Expression clamp(const Expression& a, const Expression& low, const Expression& high);
Expression sin(const Expression& a);  // rad, |a| up to 1e5
Expression cos(const Expression& a);
Expression exp(const Expression& a);
Expression log(const Expression& a);  // natural; -inf at 0, NaN below
// a to the power of b, with an error of up to 2 + |b ln a| units in the last place. NaN for a < 0,
// unless b is an integer. Products such as square() are more accurate.
Expression pow(const Expression& a, const Expression& b);
Expression tanh(const Expression& a);
Expression acos(const Expression& a);  // rad, 0 to pi; NaN outside of -1 to 1
// Remainder of a / b with the sign of b: from 0 up to, but not including, b.
Expression mod(const Expression& a, const Expression& b);
Expression sign(const Expression& a);                        // -1, 0 or 1
Expression atan2(const Expression& y, const Expression& x);  // rad, -pi to pi; 0 for (0, 0)

// A user-defined function, called for several worlds at a time: out[l] from in[0][l], in[1][l], ...
// in the batch's precision. It runs on the stepping threads and must not throw. For reproducible
// bits, a lane must not depend on other lanes.
class LaneFunction {
 public:
  virtual ~LaneFunction() = default;
  virtual void operator()(int lanes, std::span<const float* const> in, float* out) const = 0;
  virtual void operator()(int lanes, std::span<const double* const> in, double* out) const = 0;
};
Expression lane_function(std::shared_ptr<const LaneFunction> function, std::vector<Expression> in);

// How often a random number is drawn.
enum class Every {
  episode,  // at its start: goals
  step,     // also at every step of the task: noise
};
const char* to_string(Every every);

// Values of a world at the end of a step of the task, or at the start of an episode. Bodies and
// joints are those of the scene. Axis 0, 1, 2 is x, y, z of the world. A body or joint that does
// not exist is an issue of the task.
namespace terms {

Expression position(BodyId body, int axis);           // m, of the body frame
Expression velocity(BodyId body, int axis);           // m/s, of the centre of mass
Expression angular_velocity(BodyId body, int axis);   // rad/s; in the plane axis 2
Expression angle(BodyId body);                        // rad, -pi to pi, in the plane
Expression direction(BodyId body, int of, int axis);  // a component of the body's x, y or z axis

// A component of an observed value (observed.hpp); the task's batch gets its observer. `item` is a
// body, a joint, or a ray or point of the task; 0 for values of the world. For values of
// coordinates, `item` is the joint and `component` its coordinate. Other components count as axes:
// a planar spin is 2. Values of ObservedOf::step are 0 at the start of an episode.
Expression observed(Observed what, int item = 0, int component = 0);
inline Expression joint_position(JointId joint, int coordinate = 0) {
  return observed(Observed::joint_position, joint.index(), coordinate);
}
inline Expression joint_speed(JointId joint, int coordinate = 0) {
  return observed(Observed::joint_speed, joint.index(), coordinate);
}
// Loads in the last substep, with every solver.
inline Expression joint_force(JointId joint, int axis) {  // N, on body B, world axes
  return observed(Observed::joint_force, joint.index(), axis);
}
inline Expression joint_torque(JointId joint, int axis) {  // N m, about B's anchor; planar axis 2
  return observed(Observed::joint_torque, joint.index(), axis);
}
// N or N m along a coordinate: drive or spring, with Solver::newton the actuators.
inline Expression drive_force(JointId joint, int coordinate = 0) {
  return observed(Observed::drive_force, joint.index(), coordinate);
}
inline Expression touching(BodyId body) {  // 1 if a contact acted on it in the last step
  return observed(Observed::touching, body.index());
}
inline Expression linear_acceleration(BodyId body, int axis) {  // m/s^2, of its centre of mass
  return observed(Observed::linear_acceleration, body.index(), axis);
}
inline Expression angular_acceleration(BodyId body, int axis) {  // rad/s^2; in the plane axis 2
  return observed(Observed::angular_acceleration, body.index(), axis);
}
inline Expression proper_acceleration(BodyId body, int axis) {  // m/s^2, body axes
  return observed(Observed::proper_acceleration, body.index(), axis);
}
inline Expression point_position(int point, int axis) {  // m, of Task::points
  return observed(Observed::point_position, point, axis);
}
inline Expression point_velocity(int point, int axis) {  // m/s
  return observed(Observed::point_velocity, point, axis);
}
inline Expression ray_distance(int ray) {  // m, of Task::rays
  return observed(Observed::ray_distance, ray);
}

// Solver::newton only, by MuJoCo's indices (docs/robots.md, "Coordinates"). link_position,
// link_center, external_force and external_torque exist for all solvers (observed.hpp).
Expression generalized_position(int coordinate);  // m, rad, or a component of a quaternion
Expression generalized_velocity(int dof);         // m/s or rad/s
// At the last force computation, which is one substep behind the state (observed.hpp).
inline Expression link_position(BodyId body, int axis) {  // m, of the body frame
  return observed(Observed::link_position, body.index(), axis);
}
inline Expression link_center(BodyId body, int axis) {  // m, of the centre of mass
  return observed(Observed::link_center, body.index(), axis);
}
inline Expression external_force(BodyId body, int axis) {  // N, of contacts and inputs
  return observed(Observed::external_force, body.index(), axis);
}
inline Expression external_torque(BodyId body, int axis) {  // N m, about its tree's mass centre
  return observed(Observed::external_torque, body.index(), axis);
}
inline Expression actuator_force(int dof) {  // N or N m
  return observed(Observed::actuator_force, dof);
}
inline Expression constraint_force(int dof) {  // N or N m, of limits and contacts
  return observed(Observed::constraint_force, dof);
}
inline Expression tendon_length(TendonId tendon) {  // m or rad, the unit of its terms
  return observed(Observed::tendon_length, tendon.index());
}
inline Expression tendon_velocity(TendonId tendon) {  // m/s or rad/s
  return observed(Observed::tendon_velocity, tendon.index());
}
// All solvers. Solvers other than newton use the current state.
inline Expression site_position(SiteId site, int axis) {  // m
  return observed(Observed::site_position, site.index(), axis);
}

Expression action(int index = 0);       // of this step; discrete tasks: the choice; 0 at the start
Expression control(ControlId control);  // value of the scene's control in this step
// Number of steps of the task in the episode, including this one. In Task::controls the step to
// take counts: 1 in the first step.
Expression age();
Expression time_step();  // s, one step of the task: frame_skip steps of the scene
Expression lost();       // 1 if the world is lost (Status)

// A random number, uniform from low to high or normal. It depends on its name, the seed and the
// episode of the world, and with Every::step on age(). In Task::controls, that is the age() of the
// step to take. Equal names give equal numbers in all expressions of the task; different names are
// independent. Copies of a world, also from snapshots, draw the same numbers until their episode
// ends.
Expression uniform(std::string_view name, Every every, const Expression& low = 0,
                   const Expression& high = 1);
Expression normal(std::string_view name, Every every, const Expression& mean = 0,
                  const Expression& deviation = 1);

// A parameter of the scene in this world (variation.hpp, Batch::read). A parameter with a variation
// has a value per world. `component` is the index in a parameter of several values.
Expression parameter(Parameter of, int component = 0);  // of the world: gravity, wind
Expression parameter(Parameter of, BodyId body, int component = 0);
Expression parameter(Parameter of, ShapeId shape, int component = 0);
Expression parameter(Parameter of, JointId joint, int component = 0);
Expression parameter(Parameter of, ControlId control, int component = 0);
// `attractor`: index in Scene::attractors.
Expression attractor_parameter(Parameter of, int attractor, int component = 0);

// A level of this world by name (Task::levels). It outlives episodes and is constant within one.
Expression level(std::string_view name);

// A memory of this world by name (Task::memories). In Task::controls it has its value after the
// last step.
Expression memory(std::string_view name);

// The value at the end of the previous step; in the first step, the value at the start of the
// episode. In Task::controls: the value at the current state.
Expression previous(const Expression& value);
// The value `steps` steps earlier, 0 to 256. In the first steps it is the value at the start of the
// episode, where actions are 0. In Task::controls, 0 is the step to take: delayed(action(0), 2) is
// the action of two steps ago. There previous() reads the state, and delayed(previous(...), 1) the
// state one step earlier. Each step of delay stores a value per world. Throws std::invalid_argument
// if `steps` is out of range.
Expression delayed(const Expression& value, int steps);
// Delay by an expression, rounded down and clamped to 0 and `max_steps`. A NaN counts as
// `max_steps`. `max_steps`, 0 to 256, is the number of stored values.
Expression delayed(const Expression& value, const Expression& steps, int max_steps);

// Functions of all steps of the episode so far. In Task::controls the step to take counts, so their
// operands must be known before it. There previous(...) reads the state and the results of the last
// step.
//
// Number of consecutive steps, up to this one, at whose end the condition was true; 0 at the start.
Expression held(const Expression& condition);
// The largest value of the episode so far, including its start.
Expression largest(const Expression& value);
// 1 once the condition was true in this episode, including at its start; 0 before.
Expression latched(const Expression& condition);
// The sum of the values at the ends of the steps so far; 0 at the start.
Expression summed(const Expression& value);
// Exponential moving average. It starts at `value` and moves by `factor` times the difference in
// each step. With factor 1 it equals `value`, with 0 it is constant.
Expression smoothed(const Expression& value, const Expression& factor);
// The same with a time constant, s: factor = 1 - exp(-time_step() / time_constant).
Expression smoothed_over(const Expression& value, const Expression& time_constant);
// Cycles since the start of the episode, modulo 1. Grows by frequency (Hz) times time_step() in
// each step. A negative frequency runs backwards.
Expression phase(const Expression& frequency);

}  // namespace terms
}  // namespace manyworlds
