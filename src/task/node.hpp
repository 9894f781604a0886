// Node: what an Expression is made of.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "kernels/data/program.hpp"
#include "manyworlds/expression.hpp"
#include "src/scene/variations.hpp"

namespace manyworlds {

enum class Term {
  number,
  arithmetic,  // Node::operation of the operands, or what it remembers of one
  function,
  position,  // from here on: of Node::index
  velocity,
  angular_velocity,
  angle,
  direction,
  generalized_position,
  generalized_velocity,
  observed,
  action,
  control,
  age,
  lost,
  uniform,    // Node::text is its name, index its number, of: Every
  parameter,  // of: Parameter, of index, a shape's `shape`, component axis
  level,      // of the name Node::text
  memory,     // of the name Node::text
  time_step,
  raw,  // row of the state, as the kernels have it: of the plan, not of users
};

struct Expression::Node {
  Term term = Term::number;
  double number = 0;
  int index = -1;  // body, action, control, coordinate, dof, row, or item of what is observed
  int of = 0;      // axis of a body, or Observed
  int axis = 0;    // of the world, or component of what is observed
  int shape = -1;
  std::string text = {};
  kernels::Operation operation{};
  std::vector<Expression> operands{};
  std::shared_ptr<const LaneFunction> function{};
  int depth = 0;  // of operands within operands
};

// Throws std::invalid_argument for expressions that are nested too deeply to be walked through.
Expression make_expression(Expression::Node node);
Expression arithmetic(kernels::Operation operation, std::vector<Expression> operands);

// The value depends on earlier steps of the episode, in a row of memory of its own.
inline bool accumulates(kernels::Operation operation) {
  switch (operation) {
    case kernels::Operation::held:
    case kernels::Operation::largest:
    case kernels::Operation::latched:
    case kernels::Operation::summed:
    case kernels::Operation::smoothed:
    case kernels::Operation::phase: return true;
    default: return false;
  }
}

// What has the number that a `parameter` node is about.
NumberOwner owner_of(const Expression::Node& node);

// What `observed` nodes are about; nullptr: others. Coordinates are those of a joint, Node::index.
const ObservedInfo* observed_by(const Expression::Node& node);
bool has_item(const ObservedInfo& what);       // is it of an item, Node::index?
bool has_component(const ObservedInfo& what);  // of several, Node::axis?

// "position of body 3, axis 1"; the text of other expressions, cut to a line.
std::string describe(const Expression& expression);

}  // namespace manyworlds
