// Expression: a number of every world that a task (task.hpp) works out after each of its steps, in
// all lanes at once. Made from what the world is (namespace terms) by arithmetic, evaluated in the
// batch's precision. Truth is 1 and what is not 0.
//
//   const Expression lean = terms::angle(pole);
//   const Expression fallen = abs(lean) > 0.2;
//   const Expression reward = 1 - 0.1 * square(terms::position(cart, 0)) - 10 * fallen;
//
// The same bits for a world whatever its lane, the batch, threads and instruction set.
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
  // Throws std::invalid_argument for null. An Expression that is moved from stays what it was.
  explicit Expression(std::shared_ptr<const Node> node);
  Expression(const Expression&) = default;
  Expression& operator=(const Expression&) = default;
  const Node& node() const { return *node_; }

 private:
  std::shared_ptr<const Node> node_;
};

// The whole expression as Python writes it: "1 - 0.1 * (position(0, 'x') * position(0, 'x'))".
// Beyond 20,000 characters, subexpressions that are nested deeply are "...".
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
Expression operator&(const Expression& a, const Expression& b);  // both are true
Expression operator|(const Expression& a, const Expression& b);  // one is
Expression operator!(const Expression& a);
Expression equal(const Expression& a, const Expression& b);
Expression select(const Expression& condition, const Expression& yes, const Expression& no);

Expression abs(const Expression& a);
Expression square(const Expression& a);
Expression sqrt(const Expression& a);
Expression floor(const Expression& a);  // the next whole number below
Expression min(const Expression& a, const Expression& b);
Expression max(const Expression& a, const Expression& b);
Expression clamp(const Expression& a, const Expression& low, const Expression& high);
Expression sin(const Expression& a);  // rad, of up to 1e5 rad
Expression cos(const Expression& a);
Expression exp(const Expression& a);
Expression log(const Expression& a);  // natural; -inf of 0, not a number below
// a to the power of b, to 2 + |b ln a| units in the last place. Of a < 0 where b is whole, else not
// a number. Products are exacter: square.
Expression pow(const Expression& a, const Expression& b);
Expression tanh(const Expression& a);
Expression acos(const Expression& a);  // rad, 0 to pi; not a number beyond -1 to 1
// What is left of a beside whole multiples of b, with the sign of b: 0 up to b without b.
Expression mod(const Expression& a, const Expression& b);
Expression sign(const Expression& a);                        // -1, 0 or 1
Expression atan2(const Expression& y, const Expression& x);  // rad, -pi to pi; 0 for (0, 0)

// A function of one's own, worked out for several worlds at a time: out[l] from in[0][l], in[1][l],
// ... Called on the threads that step; must not throw, and to keep the promise of same bits it must
// not let lanes know of each other. In the precision of the batch.
class LaneFunction {
 public:
  virtual ~LaneFunction() = default;
  virtual void operator()(int lanes, std::span<const float* const> in, float* out) const = 0;
  virtual void operator()(int lanes, std::span<const double* const> in, double* out) const = 0;
};
Expression lane_function(std::shared_ptr<const LaneFunction> function, std::vector<Expression> in);

// How often a random number is drawn.
enum class Every {
  episode,  // where it begins: goals
  step,     // and at every step of the task: noise
};
const char* to_string(Every every);

// What a world is at the end of a step of the task, or where it begins. Bodies and joints are those
// of the scene; axis 0, 1, 2 is x, y, z of the world. What does not exist is an error of the task.
namespace terms {

Expression position(BodyId body, int axis);           // m, of the body frame
Expression velocity(BodyId body, int axis);           // m/s, of the centre of mass
Expression angular_velocity(BodyId body, int axis);   // rad/s; in the plane axis 2
Expression angle(BodyId body);                        // rad, -pi to pi, in the plane
Expression direction(BodyId body, int of, int axis);  // a component of the body's x, y or z axis

// A component of what an observer sees (observed.hpp), which the task's batch then has. The item is
// a body, a joint, or a ray or point of the task, 0 for what is of the world; of what is of a
// coordinate, the joint, and the component its coordinate. Components count as axes do: a spin of
// the plane is 2. What only a step makes is 0 where a world begins.
Expression observed(Observed what, int item = 0, int component = 0);
inline Expression joint_position(JointId joint, int coordinate = 0) {
  return observed(Observed::joint_position, joint.index(), coordinate);
}
inline Expression joint_speed(JointId joint, int coordinate = 0) {
  return observed(Observed::joint_speed, joint.index(), coordinate);
}
// Of every solver, in the last substep.
inline Expression joint_force(JointId joint, int axis) {  // N, on body B, world axes
  return observed(Observed::joint_force, joint.index(), axis);
}
inline Expression joint_torque(JointId joint, int axis) {  // N m, about B's anchor; planar axis 2
  return observed(Observed::joint_torque, joint.index(), axis);
}
// N or N m along a coordinate, of the drive or spring; with Solver::newton of the actuators.
inline Expression drive_force(JointId joint, int coordinate = 0) {
  return observed(Observed::drive_force, joint.index(), coordinate);
}
inline Expression touching(BodyId body) {  // a contact acted on it in the last step
  return observed(Observed::touching, body.index());
}
inline Expression linear_acceleration(BodyId body, int axis) {  // m/s^2, of its centre of mass
  return observed(Observed::linear_acceleration, body.index(), axis);
}
inline Expression angular_acceleration(BodyId body, int axis) {  // rad/s^2; in the plane axis 2
  return observed(Observed::angular_acceleration, body.index(), axis);
}
inline Expression proper_acceleration(BodyId body, int axis) {  // m/s^2; the axis is the body's
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

// Of Solver::newton, by MuJoCo's indices (docs/robots.md, "Coordinates"). Of other solvers there
// are link_position, link_center, external_force and external_torque (observed.hpp).
Expression generalized_position(int coordinate);  // m, rad, or of a quaternion
Expression generalized_velocity(int dof);         // m/s or rad/s
// As the last substep found its forces, which is one substep behind the state (observed.hpp).
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
inline Expression tendon_length(TendonId tendon) {  // m or rad, as its terms are
  return observed(Observed::tendon_length, tendon.index());
}
inline Expression tendon_velocity(TendonId tendon) {  // m/s or rad/s
  return observed(Observed::tendon_velocity, tendon.index());
}
// Of all solvers; of others where the state has it.
inline Expression site_position(SiteId site, int axis) {  // m
  return observed(Observed::site_position, site.index(), axis);
}

Expression action(
    int index = 0);  // that led here; of discrete tasks its number. 0 at the beginning
Expression control(ControlId control);  // that led here: of the scene
// Steps of the task since the episode began, including this one. In Task::controls the step to take
// counts: 1 in the first step.
Expression age();
Expression time_step();  // s, of one step of the task: frame_skip steps of the scene
Expression lost();       // the world is lost (Status)

// A random number from low to high, or a normal one. It depends on its name, on the seed and the
// episode of the world and, where it is of every step, on age() alone; before the steps, where
// Task::controls are worked out, on that of the step to take. So those of one name are the same in
// all expressions of the task, and others know nothing of them. Copies of a world, of snapshots
// too, draw what it would have drawn until their episode ends.
Expression uniform(std::string_view name, Every every, const Expression& low = 0,
                   const Expression& high = 1);
Expression normal(std::string_view name, Every every, const Expression& mean = 0,
                  const Expression& deviation = 1);

// A number of the scene as this world has it (variation.hpp, Batch::read), of what has it; those
// that vary are the world's own. `component` counts within the numbers of a parameter.
Expression parameter(Parameter of, int component = 0);  // of the world: gravity
Expression parameter(Parameter of, BodyId body, int component = 0);
Expression parameter(Parameter of, ShapeId shape, int component = 0);
Expression parameter(Parameter of, JointId joint, int component = 0);
Expression parameter(Parameter of, ControlId control, int component = 0);
// Of an attractor, its index in Scene::attractors.
Expression attractor_parameter(Parameter of, int attractor, int component = 0);

// A number of this world that outlives its episodes, and is the same for the whole of one
// (Task::levels, by name).
Expression level(std::string_view name);

// A number of this world that the task remembers from step to step (Task::memories, by name). In
// Task::controls it is as the last step left it.
Expression memory(std::string_view name);

// What `value` was at the end of the step before; in the first step where the world began. In
// Task::controls: what it is.
Expression previous(const Expression& value);
// What it was so many steps before, 0 to 256; in the first steps where the world began, so actions
// are 0 then. In Task::controls too, where 0 is the step to take: delayed(action(0), 2) is what was
// asked for two steps ago; the state of the world is behind previous(), one step more behind
// delayed(previous(...), 1). Each step is a number that a world remembers. Throws
// std::invalid_argument for other numbers of steps.
Expression delayed(const Expression& value, int steps);
// By as many steps as `steps` says in this world and step: rounded down, kept within 0 and
// `max_steps`, 0 to 256, which is what is remembered. What is not a number counts as `max_steps`.
Expression delayed(const Expression& value, const Expression& steps, int max_steps);

// Functions of all steps of the episode so far. In Task::controls the step to take counts, so their
// operands must be known before it; previous(...) reads the state and what the last step left.
//
// Steps in a row, up to this one, at whose end the condition was true; 0 at the beginning.
Expression held(const Expression& condition);
// The largest value since the beginning, which counts.
Expression largest(const Expression& value);
// 1 once the condition was true in this episode, the beginning included; 0 before.
Expression latched(const Expression& condition);
// The sum of the values at the ends of the steps so far; 0 at the beginning.
Expression summed(const Expression& value);
// Exponential moving average: starts at `value`, and moves by `factor` times the difference from
// it in each step; 1 follows at once, 0 never.
Expression smoothed(const Expression& value, const Expression& factor);
// The same with a time constant, s: factor = 1 - exp(-time_step() / time_constant).
Expression smoothed_over(const Expression& value, const Expression& time_constant);
// Cycles since the beginning without whole ones, 0 up to 1: grows by frequency (Hz) times
// time_step() in each step. A negative frequency runs backwards.
Expression phase(const Expression& frequency);

}  // namespace terms
}  // namespace manyworlds
