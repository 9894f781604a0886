#include "src/task/program.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "kernels/data/observer.hpp"
#include "src/base/random.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/state_layout.hpp"

namespace manyworlds {

using kernels::Operation;

int ProgramBuilder::add(const Expression& expression) {
  const Expression::Node* node = &expression.node();
  auto& known = known_[updates_];
  if (const auto found = known.find(node); found != known.end()) return found->second;
  const int row = add_node(*node);
  known.emplace(node, row);
  kept_.push_back(expression);
  return row;
}

int ProgramBuilder::add_node(const Expression::Node& n) {
  switch (n.term) {
    case Term::number: return emit(Operation::constant, -1, -1, -1, n.number);
    case Term::function: return add_function(n);
    case Term::arithmetic: break;
    case Term::position: return add(position(n.index, n.axis));
    case Term::velocity: return add(velocity(n.index, n.axis));
    case Term::angular_velocity: return add(angular_velocity(n.index, n.axis));
    case Term::angle: return add(angle(n.index));
    case Term::direction: return add(direction(n.index, n.of, n.axis));
    case Term::generalized_position: return add_coordinate(Field::generalized_position, n.index);
    case Term::generalized_velocity: return add_coordinate(Field::generalized_velocity, n.index);
    case Term::observed: return add_observed(n);
    case Term::action: return emit(Operation::input, n.index);
    case Term::control: return emit(Operation::control, n.index);
    case Term::age: return emit(Operation::input, inputs_.age());
    case Term::lost: return emit(Operation::input, inputs_.lost());
    case Term::uniform:
      return add_number({.kind = static_cast<Every>(n.of) == Every::step ? HostNumber::of_step
                                                                         : HostNumber::of_episode,
                         .stream = stream_of(n.text),
                         .count = static_cast<std::uint64_t>(n.index)});
    case Term::parameter: return add_parameter(n);
    case Term::level: return add_level(n.text);
    case Term::memory: return add_memory(n.text);
    case Term::time_step:
      return emit(Operation::constant, -1, -1, -1, task_.frame_skip * plan_.scene().options.dt);
    case Term::raw: return emit(Operation::state, n.index);
  }
  if (n.operation == Operation::previous) return add_previous(n.operands[0]);
  if (accumulates(n.operation)) return add_accumulated(n);
  int operand[3] = {-1, -1, -1};
  std::transform(n.operands.begin(), n.operands.end(), operand,
                 [this](const Expression& e) { return add(e); });
  return emit(n.operation, operand[0], operand[1], operand[2]);
}

int ProgramBuilder::add_observed(const Expression::Node& n) {
  const int observer = static_cast<int>(observed_by(n)->observer);
  int item = n.index, component = n.axis;
  switch (kObserverInfo[observer].item) {
    case ObservedItem::body: item = plan_.row(BodyId(n.index)); break;
    case ObservedItem::coordinate:
      item = plan_.first_observed(JointId(n.index)) + n.axis;
      component = 0;
      break;
    default: break;
  }
  const auto& rows = kernels::kObserverRows;
  return emit(Operation::seen, item * rows.of_item[observer] + rows.first[n.of] + component,
              observer);
}

int ProgramBuilder::add_coordinate(Field field, int item) {
  return emit(Operation::state, state_layout(plan_.data()).row_of(field, item));
}

HostNumber ProgramBuilder::number_of(const Expression::Node& n) const {
  const auto parameter = static_cast<Parameter>(n.of);
  const std::vector<NumberOwner> owners = owners_of(plan_.data().scene, parameter);
  const auto at = std::find(owners.begin(), owners.end(), owner_of(n)) - owners.begin();
  const auto numbers = static_cast<std::size_t>(info(parameter).numbers);
  return {.kind = HostNumber::parameter,
          .of = parameter,
          .item = static_cast<std::size_t>(at) * numbers + static_cast<std::size_t>(n.axis)};
}

// What no variation can change is a constant.
int ProgramBuilder::add_parameter(const Expression::Node& n) {
  const auto parameter = static_cast<Parameter>(n.of);
  const NumberOwner of = owner_of(n);
  const PlanData& plan = plan_.data();
  const auto changes = [&](const VariedNumber& v) {
    if (parameter == Parameter::mass) return v.of.body == of.body;  // by its sizes and densities
    if (of.control >= 0) return v.of.control == of.control;         // gains of servos
    return v.parameter == parameter && v.of == of && v.component == n.axis;
  };
  if (std::none_of(plan.varied.begin(), plan.varied.end(), changes)) {
    return emit(Operation::constant, -1, -1, -1, get_number(plan.scene, parameter, of, n.axis));
  }
  return add_number(number_of(n));
}

int ProgramBuilder::add_level(const std::string& name) {
  const auto& all = inputs_.levels;
  const auto at = std::find(all.begin(), all.end(), name) - all.begin();
  return add_number({.kind = HostNumber::level, .item = static_cast<std::size_t>(at)});
}

// Before the steps the memory is what the last steps left.
int ProgramBuilder::add_previous(const Expression& value) {
  if (looks_back_) {
    return emit(Operation::previous, -1, looks_back_->remember(looks_back_->add(value)));
  }
  const int of = add(value);
  return emit(Operation::previous, of, remember(of));
}

// Before the steps this is the same function of the same memory, with the operands of the step to
// take, so it comes to what it will be after them.
int ProgramBuilder::add_accumulated(const Expression::Node& n) {
  const bool cycles = n.operation == Operation::phase;  // of the frequency
  const int a = add(cycles ? n.operands[0] * terms::time_step() : n.operands[0]);
  const int c = n.operands.size() > 1 ? add(n.operands[1]) : -1;
  if (looks_back_) {
    const auto of = static_cast<std::size_t>(looks_back_->add_node(n));
    return emit(n.operation, a, looks_back_->program_.instructions[of].b, c);
  }
  const std::size_t before = program_.instructions.size();
  const int row = emit(n.operation, a, static_cast<int>(memory_.row.size()), c);
  if (program_.instructions.size() > before) memory_.row.push_back(row);
  return row;
}

int ProgramBuilder::add_memory(const std::string& name) {
  const auto is_it = [&name](const Memory& memory) { return memory.name == name; };
  const auto& all = task_.memories;
  const auto index =
      static_cast<std::size_t>(std::find_if(all.begin(), all.end(), is_it) - all.begin());
  if (looks_back_) {
    looks_back_->add_memory(name);
    return emit(Operation::previous, -1, looks_back_->named_[index].number);
  }
  Named& own = named_[index];
  if (own.number < 0) {
    own.number = static_cast<int>(memory_.row.size());
    memory_.row.push_back(-1);
    const bool updates = std::exchange(updates_, false);
    own.begin = add(all[index].begin);
    own.before = emit(Operation::previous, own.begin, own.number);
    updates_ = true;
    const int next = all[index].next ? add(*all[index].next) : own.before;
    updates_ = updates;
    own.after = emit(Operation::begins, own.begin, next);
    memory_.row[static_cast<std::size_t>(own.number)] = own.after;
  }
  return updates_ ? own.before : own.after;
}

int ProgramBuilder::add_number(const HostNumber& number) {
  auto& all = inputs_.numbers;
  const auto found = std::find(all.begin(), all.end(), number);
  const auto index = static_cast<int>(found - all.begin());
  if (found == all.end()) all.push_back(number);
  return emit(Operation::input, inputs_.first_number() + index);
}

int ProgramBuilder::add_function(const Expression::Node& n) {
  Program::Call call{0, n.function, {}};
  for (const Expression& e : n.operands) call.in.push_back(add(e));
  call.at = static_cast<int>(program_.instructions.size());
  program_.instructions.push_back({Operation::constant, -1, -1, -1, 0});  // its row
  program_.calls.push_back(std::move(call));
  return program_.calls.back().at;
}

int ProgramBuilder::remember(int row) {
  const auto found = std::find(memory_.row.begin(), memory_.row.end(), row);
  if (found == memory_.row.end()) memory_.row.push_back(row);
  return static_cast<int>(std::find(memory_.row.begin(), memory_.row.end(), row) -
                          memory_.row.begin());
}

int ProgramBuilder::emit(Operation operation, int a, int b, int c, double number) {
  // What these remember is their own: two of the same operands are the same.
  const int shared = accumulates(operation) ? -1 : b;
  const Key key{static_cast<int>(operation), a, shared, c, std::bit_cast<std::uint64_t>(number)};
  const auto [at, fresh] = same_.emplace(key, static_cast<int>(program_.instructions.size()));
  if (fresh) program_.instructions.push_back({operation, a, b, c, number});
  return at->second;
}

Expression ProgramBuilder::state(int body, int component) const {
  const PlanData& plan = plan_.data();
  const StateLayout layout = state_layout(plan);
  Expression::Node node;
  node.term = Term::raw;
  node.index =
      plan_.row(BodyId(body)) * layout.stride[static_cast<int>(ItemKind::body)] + component;
  return make_expression(std::move(node));
}

namespace {

const Body& described(const Plan& plan, int body) {
  return plan.scene().bodies[static_cast<std::size_t>(body)];
}
const PlanBody* moving(const Plan& plan, int body) {
  const auto row = plan.find_row(BodyId(body));
  return row ? &plan.data().bodies[static_cast<std::size_t>(*row)] : nullptr;
}
kernels::StateOffsets offsets(const PlanData& plan) {
  return kernels::state_offsets(plan.dimension());
}

// The sum of those products whose number is not 0.
class Sum {
 public:
  void add(double factor, const Expression& e) {
    if (factor == 0) return;
    const Expression term = factor == 1 ? e : Expression(factor) * e;
    sum_ = empty_ ? term : sum_ + term;
    empty_ = false;
  }
  Expression value() const { return sum_; }

 private:
  Expression sum_ = 0;
  bool empty_ = true;
};

}  // namespace

Expression ProgramBuilder::direction(int body, int of, int axis) const {
  const PlanBody* b = moving(plan_, body);
  const bool rotates = b != nullptr && plan_.has(Feature::orientation);
  if (!rotates) {
    const Mat3 r = b ? Mat3(Mat3::Identity())
                     : described(plan_, body).rotation.normalized().toRotationMatrix();
    return r(axis, of);
  }
  const int q = offsets(plan_.data()).orientation;
  if (plan_.scene().space == Space::planar) {
    const Expression c = state(body, q), s = state(body, q + 1);
    if (axis == 2 || of == 2) return axis == of ? 1 : 0;
    if (axis == of) return c;
    return axis == 1 ? s : -s;
  }
  // The body's axis in principal axes, rotated by the quaternion of those.
  const Vec3 v = b->principal.conjugate() * Vec3::Unit(of);
  const Expression w = state(body, q),
                   u[3] = {state(body, q + 1), state(body, q + 2), state(body, q + 3)};
  Sum sum;
  for (int k = 0; k < 3; ++k) {
    if (k == axis) {
      sum.add(v[k], 1 - 2 * (square(u[(k + 1) % 3]) + square(u[(k + 2) % 3])));
      continue;
    }
    // R(i, k) = 2 (u_i u_k +- w u_m), m the third: minus where k follows i.
    const Expression both = u[axis] * u[k], third = w * u[3 - axis - k];
    sum.add(2 * v[k], (axis + 1) % 3 == k ? both - third : both + third);
  }
  return sum.value();
}

Expression ProgramBuilder::position(int body, int axis) const {
  const PlanBody* b = moving(plan_, body);
  if (!b) return described(plan_, body).position[axis];
  const Expression center = state(body, offsets(plan_.data()).position + axis);
  if (b->aligned) return center;
  Sum shift;
  for (int k = 0; k < 3; ++k) shift.add(b->center[k], direction(body, k, axis));
  return b->center.isZero(0) ? center : center - shift.value();
}

Expression ProgramBuilder::velocity(int body, int axis) const {
  if (!moving(plan_, body)) return 0;
  return state(body, offsets(plan_.data()).linear + axis);
}

Expression ProgramBuilder::angular_velocity(int body, int axis) const {
  if (!moving(plan_, body)) return 0;
  const bool planar = plan_.scene().space == Space::planar;
  return state(body, offsets(plan_.data()).angular + (planar ? 0 : axis));
}

Expression ProgramBuilder::angle(int body) const {
  return atan2(direction(body, 0, 1), direction(body, 0, 0));
}

}  // namespace manyworlds
