// Expressions out of expressions.
#include <algorithm>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "manyworlds/expression_graph.hpp"
#include "manyworlds/observe.hpp"
#include "src/base/enum_names.hpp"
#include "src/task/node.hpp"

namespace manyworlds {

namespace {

using kernels::Operation;

// Expressions are walked through and destroyed by functions that call themselves.
constexpr int kMaxDepth = 2000;
constexpr int kMaxDelay = 256;

const char* word_of(ObservedItem item) {
  switch (item) {
    case ObservedItem::world: return "world";
    case ObservedItem::body: return "body";
    case ObservedItem::joint:
    case ObservedItem::coordinate: return "joint";
    case ObservedItem::dof: return "dof";
    case ObservedItem::tendon: return "tendon";
    case ObservedItem::site: return "site";
    case ObservedItem::ray: return "ray";
    case ObservedItem::point: return "point";
  }
  return "?";
}

Expression leaf(Term term, int index = -1, int of = 0, int axis = 0) {
  Expression::Node node;
  node.term = term;
  node.index = index;
  node.of = of;
  node.axis = axis;
  return make_expression(std::move(node));
}

}  // namespace

const char* to_string(Every every) { return name_of(every); }

Expression make_expression(Expression::Node node) {
  for (const Expression& e : node.operands) node.depth = std::max(node.depth, e.node().depth + 1);
  if (node.depth > kMaxDepth) {
    throw std::invalid_argument("an expression is nested " + std::to_string(node.depth) +
                                " levels deep, at most " + std::to_string(kMaxDepth) +
                                " are possible");
  }
  return Expression(std::make_shared<const Expression::Node>(std::move(node)));
}

Expression arithmetic(Operation operation, std::vector<Expression> operands) {
  Expression::Node node;
  node.term = Term::arithmetic;
  node.operation = operation;
  node.operands = std::move(operands);
  return make_expression(std::move(node));
}

Expression::Expression(double number) {
  Node node;
  node.number = number;
  node_ = std::make_shared<const Node>(std::move(node));
}

Expression::Expression(std::shared_ptr<const Node> node) : node_(std::move(node)) {
  if (!node_) throw std::invalid_argument("Expression: the node is null");
}

Expression lane_function(std::shared_ptr<const LaneFunction> function, std::vector<Expression> in) {
  if (!function) throw std::invalid_argument("lane_function: the function is null");
  Expression::Node node;
  node.term = Term::function;
  node.function = std::move(function);
  node.operands = std::move(in);
  return make_expression(std::move(node));
}

using E = const Expression&;
Expression operator+(E a, E b) { return arithmetic(Operation::add, {a, b}); }
Expression operator-(E a, E b) { return arithmetic(Operation::subtract, {a, b}); }
Expression operator*(E a, E b) { return arithmetic(Operation::multiply, {a, b}); }
Expression operator/(E a, E b) { return arithmetic(Operation::divide, {a, b}); }
Expression operator-(E a) { return arithmetic(Operation::negate, {a}); }
Expression operator<(E a, E b) { return arithmetic(Operation::less, {a, b}); }
Expression operator<=(E a, E b) { return arithmetic(Operation::less_equal, {a, b}); }
Expression operator>(E a, E b) { return b < a; }
Expression operator>=(E a, E b) { return b <= a; }
Expression operator&(E a, E b) { return arithmetic(Operation::both, {a, b}); }
Expression operator|(E a, E b) { return arithmetic(Operation::either, {a, b}); }
Expression operator!(E a) { return arithmetic(Operation::opposite, {a}); }
Expression equal(E a, E b) { return arithmetic(Operation::equal, {a, b}); }
Expression select(E condition, E yes, E no) {
  return arithmetic(Operation::choose, {condition, yes, no});
}
Expression abs(E a) { return arithmetic(Operation::absolute, {a}); }
Expression square(E a) { return a * a; }
Expression sqrt(E a) { return arithmetic(Operation::square_root, {a}); }
Expression floor(E a) { return arithmetic(Operation::round_down, {a}); }
Expression min(E a, E b) { return arithmetic(Operation::minimum, {a, b}); }
Expression max(E a, E b) { return arithmetic(Operation::maximum, {a, b}); }
Expression clamp(E a, E low, E high) { return min(max(a, low), high); }
Expression sin(E a) { return arithmetic(Operation::sine, {a}); }
Expression cos(E a) { return arithmetic(Operation::cosine, {a}); }
Expression exp(E a) { return arithmetic(Operation::exponential, {a}); }
Expression log(E a) { return arithmetic(Operation::logarithm, {a}); }
Expression pow(E a, E b) { return arithmetic(Operation::power, {a, b}); }
Expression tanh(E a) { return arithmetic(Operation::hyperbolic_tangent, {a}); }
Expression acos(E a) { return arithmetic(Operation::arc_cosine, {a}); }
Expression mod(E a, E b) { return arithmetic(Operation::remainder, {a, b}); }
Expression sign(E a) { return arithmetic(Operation::sign, {a}); }
Expression atan2(E y, E x) { return arithmetic(Operation::arc_tangent, {y, x}); }

namespace terms {

Expression position(BodyId body, int axis) { return leaf(Term::position, body.index(), 0, axis); }
Expression velocity(BodyId body, int axis) { return leaf(Term::velocity, body.index(), 0, axis); }
Expression angular_velocity(BodyId body, int axis) {
  return leaf(Term::angular_velocity, body.index(), 0, axis);
}
Expression angle(BodyId body) { return leaf(Term::angle, body.index()); }
Expression direction(BodyId body, int of, int axis) {
  return leaf(Term::direction, body.index(), of, axis);
}
Expression observed(Observed what, int item, int component) {
  return leaf(Term::observed, item, static_cast<int>(checked_enum(what)), component);
}
Expression generalized_position(int coordinate) {
  return leaf(Term::generalized_position, coordinate);
}
Expression generalized_velocity(int dof) { return leaf(Term::generalized_velocity, dof); }
Expression action(int index) { return leaf(Term::action, index); }
Expression control(ControlId control) { return leaf(Term::control, control.index()); }
Expression age() { return leaf(Term::age); }
Expression lost() { return leaf(Term::lost); }

namespace {

Expression drawn(std::string_view name, Every every, int index) {
  Expression::Node node;
  node.term = Term::uniform;
  node.text = name;
  node.index = index;
  node.of = static_cast<int>(checked_enum(every));
  return make_expression(std::move(node));
}
Expression number_of(Parameter of, ParameterInfo::Owner owner, int index, int shape,
                     int component) {
  const ParameterInfo& what = info(of);
  if (what.owner != owner) {
    throw std::invalid_argument(std::string("parameter: ") + what.name + " belongs to a " +
                                to_string(what.owner) + ", not to a " + to_string(owner));
  }
  Expression::Node node;
  node.term = Term::parameter;
  node.of = static_cast<int>(of);
  node.index = index;
  node.shape = shape;
  node.axis = component;
  return make_expression(std::move(node));
}

}  // namespace

Expression uniform(std::string_view name, Every every, E low, E high) {
  return low + (high - low) * drawn(name, every, 0);
}
// Box and Muller 1958.
Expression normal(std::string_view name, Every every, E mean, E deviation) {
  const Expression size = sqrt(-2 * log(1 - drawn(name, every, 0)));
  return mean + deviation * (size * cos(2 * std::numbers::pi * drawn(name, every, 1)));
}
Expression parameter(Parameter of, int component) {
  return number_of(of, ParameterInfo::world, -1, -1, component);
}
Expression parameter(Parameter of, BodyId body, int component) {
  return number_of(of, ParameterInfo::body, body.index(), -1, component);
}
Expression parameter(Parameter of, ShapeId shape, int component) {
  return number_of(of, ParameterInfo::shape, shape.body().index(), shape.index(), component);
}
Expression parameter(Parameter of, JointId joint, int component) {
  return number_of(of, ParameterInfo::joint, joint.index(), -1, component);
}
Expression parameter(Parameter of, ControlId control, int component) {
  return number_of(of, ParameterInfo::control, control.index(), -1, component);
}
Expression attractor_parameter(Parameter of, int attractor, int component) {
  return number_of(of, ParameterInfo::attractor, attractor, -1, component);
}

Expression level(std::string_view name) {
  Expression::Node node;
  node.term = Term::level;
  node.text = name;
  return make_expression(std::move(node));
}
Expression memory(std::string_view name) {
  Expression::Node node;
  node.term = Term::memory;
  node.text = name;
  return make_expression(std::move(node));
}
Expression time_step() { return leaf(Term::time_step); }

Expression previous(E value) { return arithmetic(Operation::previous, {value}); }
namespace {

// What the value was 0, 1 ... steps before.
std::vector<Expression> before(E value, const char* what, int steps) {
  if (steps < 0 || steps > kMaxDelay) {
    throw std::invalid_argument(std::string("delayed: ") + what + " is " + std::to_string(steps) +
                                ", must be 0 to " + std::to_string(kMaxDelay));
  }
  std::vector<Expression> out{value};
  for (int i = 0; i < steps; ++i) out.push_back(previous(out.back()));
  return out;
}

}  // namespace

Expression delayed(E value, int steps) { return before(value, "steps", steps).back(); }
Expression delayed(E value, E steps, int max_steps) {
  const std::vector<Expression> was = before(value, "max_steps", max_steps);
  Expression out = was.back();
  for (int i = max_steps - 1; i >= 0; --i)
    out = select(steps < i + 1, was[static_cast<std::size_t>(i)], out);
  return out;
}
Expression held(E condition) { return arithmetic(Operation::held, {condition}); }
Expression largest(E value) { return arithmetic(Operation::largest, {value}); }
Expression latched(E condition) { return arithmetic(Operation::latched, {condition}); }
Expression summed(E value) { return arithmetic(Operation::summed, {value}); }
Expression smoothed(E value, E factor) { return arithmetic(Operation::smoothed, {value, factor}); }
Expression smoothed_over(E value, E time_constant) {
  return smoothed(value, 1 - exp(-(time_step() / time_constant)));
}
Expression phase(E frequency) { return arithmetic(Operation::phase, {frequency}); }

}  // namespace terms

NumberOwner owner_of(const Expression::Node& n) {
  const ParameterInfo::Owner owner = info(static_cast<Parameter>(n.of)).owner;
  NumberOwner of;
  if (owner == ParameterInfo::body || owner == ParameterInfo::shape) of.body = n.index;
  if (owner == ParameterInfo::shape) of.shape = n.shape;
  if (owner == ParameterInfo::joint) of.joint = n.index;
  if (owner == ParameterInfo::control) of.control = n.index;
  if (owner == ParameterInfo::attractor) of.attractor = n.index;
  return of;
}

const ObservedInfo* observed_by(const Expression::Node& node) {
  return node.term == Term::observed ? &info(static_cast<Observed>(node.of)) : nullptr;
}
bool has_item(const ObservedInfo& what) { return info(what.observer).item != ObservedItem::world; }
bool has_component(const ObservedInfo& what) {
  return what.components != ObservedComponents::one ||
         info(what.observer).item == ObservedItem::coordinate;
}

namespace {

std::string observed_text(const Expression::Node& n) {
  const ObservedInfo& what = *observed_by(n);
  const ObservedItem item = info(what.observer).item;
  std::string text = what.name;
  if (has_item(what)) text += std::string(" of ") + word_of(item) + " " + std::to_string(n.index);
  if (has_component(what)) {
    text += item == ObservedItem::coordinate ? ", coordinate " : ", axis ";
    text += std::to_string(n.axis);
  }
  return text;
}

std::string parameter_text(const Expression::Node& n) {
  const ParameterInfo& what = info(static_cast<Parameter>(n.of));
  std::string text = what.name;
  if (what.owner == ParameterInfo::shape) {
    text += " of body " + std::to_string(n.index) + ", shape " + std::to_string(n.shape);
  } else if (what.owner != ParameterInfo::world) {
    text += std::string(" of ") + to_string(what.owner) + " " + std::to_string(n.index);
  }
  if (what.numbers > 1) text += ", number " + std::to_string(n.axis);
  return text;
}

}  // namespace

std::string describe(E expression) {
  const Expression::Node& n = expression.node();
  const std::string index = std::to_string(n.index), axis = ", axis " + std::to_string(n.axis);
  switch (n.term) {
    case Term::number:
    case Term::arithmetic:
    case Term::function: return text_of(expression, 72);
    case Term::position: return "position of body " + index + axis;
    case Term::velocity: return "velocity of body " + index + axis;
    case Term::angular_velocity: return "angular_velocity of body " + index + axis;
    case Term::angle: return "angle of body " + index;
    case Term::direction:
      return "direction of body " + index + "'s axis " + std::to_string(n.of) + axis;
    case Term::generalized_position: return "generalized_position " + index;
    case Term::generalized_velocity: return "generalized_velocity " + index;
    case Term::observed: return observed_text(n);
    case Term::action: return "action " + index;
    case Term::control: return "control " + index;
    case Term::age: return "age";
    case Term::lost: return "lost";
    case Term::uniform: return "the random number '" + n.text + "'";
    case Term::parameter: return parameter_text(n);
    case Term::level: return "the level '" + n.text + "'";
    case Term::memory: return "the memory '" + n.text + "'";
    case Term::time_step: return "time_step";
    case Term::raw: return "row " + index + " of the state";
  }
  return "?";
}

}  // namespace manyworlds
