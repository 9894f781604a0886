#include "manyworlds/expression_graph.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <unordered_map>

#include "manyworlds/observe.hpp"
#include "src/base/enum_names.hpp"
#include "src/task/node.hpp"

namespace manyworlds {

namespace {

using kernels::Operation;
using Node = Expression::Node;

// How tightly Python's operators bind.
enum Binding { kComparison, kOr, kAnd, kSum, kProduct, kUnary, kPower, kWhole };

struct OperationName {
  Operation operation;
  std::string_view name, sign;  // `sign`: of Python's operator, empty for functions
  std::size_t operands;
  Binding binding = kWhole;
};
constexpr OperationName kOperations[] = {
    {Operation::add, "add", "+", 2, kSum},
    {Operation::subtract, "subtract", "-", 2, kSum},
    {Operation::multiply, "multiply", "*", 2, kProduct},
    {Operation::divide, "divide", "/", 2, kProduct},
    {Operation::negate, "negate", "-", 1, kUnary},
    {Operation::absolute, "abs", "", 1},
    {Operation::square_root, "sqrt", "", 1},
    {Operation::minimum, "minimum", "", 2},
    {Operation::maximum, "maximum", "", 2},
    {Operation::round_down, "floor", "", 1},
    {Operation::sine, "sin", "", 1},
    {Operation::cosine, "cos", "", 1},
    {Operation::arc_tangent, "arctan2", "", 2},
    {Operation::exponential, "exp", "", 1},
    {Operation::logarithm, "log", "", 1},
    {Operation::power, "power", "**", 2, kPower},
    {Operation::hyperbolic_tangent, "tanh", "", 1},
    {Operation::arc_cosine, "arccos", "", 1},
    {Operation::remainder, "mod", "%", 2, kProduct},
    {Operation::sign, "sign", "", 1},
    {Operation::less, "less", "<", 2, kComparison},
    {Operation::less_equal, "less_equal", "<=", 2, kComparison},
    {Operation::equal, "equal", "==", 2, kComparison},
    {Operation::both, "both", "&", 2, kAnd},
    {Operation::either, "either", "|", 2, kOr},
    {Operation::opposite, "opposite", "~", 1, kUnary},
    {Operation::choose, "where", "", 3},
    {Operation::previous, "previous", "", 1},
    {Operation::held, "held", "", 1},
    {Operation::largest, "largest", "", 1},
    {Operation::latched, "latched", "", 1},
    {Operation::summed, "summed", "", 1},
    {Operation::smoothed, "smoothed", "", 2},
    {Operation::phase, "phase", "", 1},
};

// Which members of a node a term has, in this order.
using Member = int Node::*;
struct TermName {
  Term term;
  std::string_view name;
  std::array<Member, 3> members;
};
constexpr Member kIndex = &Node::index, kOf = &Node::of, kAxis = &Node::axis, kShape = &Node::shape;
constexpr TermName kTerms[] = {
    {Term::position, "position", {kIndex, kAxis}},
    {Term::velocity, "velocity", {kIndex, kAxis}},
    {Term::angular_velocity, "angular_velocity", {kIndex, kAxis}},
    {Term::angle, "angle", {kIndex}},
    {Term::direction, "direction", {kIndex, kOf, kAxis}},
    {Term::generalized_position, "generalized_position", {kIndex}},
    {Term::generalized_velocity, "generalized_velocity", {kIndex}},
    {Term::action, "action", {kIndex}},
    {Term::control, "control", {kIndex}},
    {Term::age, "age", {}},
    {Term::lost, "lost", {}},
    {Term::uniform, "uniform", {kOf, kIndex}},
    {Term::parameter, "parameter", {kIndex, kShape, kAxis}},
    {Term::level, "level", {}},
    {Term::memory, "memory", {}},
    {Term::time_step, "time_step", {}},
};
constexpr std::string_view kNumber = "number";

template <class Table, class Found>
auto find(const Table& table, Found found) {
  const auto* at = std::find_if(std::begin(table), std::end(table), found);
  return at == std::end(table) ? nullptr : at;
}

const OperationName& name_of(Operation operation) {
  return *find(kOperations, [=](const auto& o) { return o.operation == operation; });
}

TermName term_of(const ObservedInfo& what) {
  TermName out{Term::observed, what.name, {}};
  std::size_t count = 0;
  if (has_item(what)) out.members[count++] = kIndex;
  if (has_component(what)) out.members[count++] = kAxis;
  return out;
}

// None: a number, an operation, or nothing that Python can make.
std::optional<TermName> term_of(const Node& node) {
  if (const ObservedInfo* what = observed_by(node)) return term_of(*what);
  const auto* found = find(kTerms, [&](const auto& t) { return t.term == node.term; });
  return found ? std::optional(*found) : std::nullopt;
}

// What is not a number of a term; terms without it have none.
bool has_text(Term term) {
  return term == Term::uniform || term == Term::parameter || term == Term::level ||
         term == Term::memory;
}
std::string text_of(const Node& node) {
  return node.term == Term::parameter ? info(static_cast<Parameter>(node.of)).name : node.text;
}

class Exporter {
 public:
  int add(const Expression& e) {
    const Node& node = e.node();
    if (const auto known = known_.find(&node); known != known_.end()) return known->second;
    ExpressionGraph::Node out;
    if (node.term == Term::number) {
      out = {std::string(kNumber), node.number, {}, {}};
    } else if (node.term == Term::arithmetic) {
      out.name = name_of(node.operation).name;
      for (const Expression& operand : node.operands) out.arguments.push_back(add(operand));
    } else if (const auto term = term_of(node)) {
      out.name = term->name;
      for (const Member member : term->members) {
        if (member != nullptr) out.arguments.push_back(node.*member);
      }
      out.text = text_of(node);
    } else {
      throw std::invalid_argument(
          "the expression contains a C++ function, which has no plain values");
    }
    graph.nodes.push_back(std::move(out));
    const int index = static_cast<int>(known_.size());
    known_.emplace(&node, index);
    return index;
  }

  ExpressionGraph graph;

 private:
  std::unordered_map<const Node*, int> known_;
};

[[noreturn]] void wrong_node(std::size_t at, const std::string& what) {
  throw std::invalid_argument("nodes[" + std::to_string(at) + "] " + what);
}

// What `from` says of a random number, a parameter, a level or a memory beside its indices.
void read_text(const ExpressionGraph::Node& from, std::size_t at, Node& node) {
  if (node.term == Term::level || node.term == Term::memory) {
    node.text = from.text;
    return;
  }
  if (node.term == Term::uniform) {
    node.text = from.text;
    if (!is_named(static_cast<Every>(node.of))) {
      wrong_node(at, "is drawn every " + std::to_string(node.of) + ", must be 0 or 1");
    }
    return;
  }
  const auto& names = EnumTable<Parameter>::names;
  const auto found = std::find(names.begin(), names.end(), from.text);
  if (found == names.end())
    wrong_node(at, "is the parameter '" + from.text + "', which does not exist");
  node.of = static_cast<int>(found - names.begin());
}

// The term of that name; sets which Observed it is, if it is one.
std::optional<TermName> term_named(std::string_view name, Node& node) {
  const auto named = [name](const auto& t) { return t.name == name; };
  if (const auto* term = find(kTerms, named)) return *term;
  const auto* what = find(kObservedInfo, named);
  if (what == nullptr) return std::nullopt;
  node.index = 0;
  node.of = static_cast<int>(what - kObservedInfo);
  return term_of(*what);
}

Expression read_node(const ExpressionGraph::Node& from, std::span<const Expression> before) {
  const std::size_t at = before.size();
  const auto count = [&](std::size_t wanted) {
    if (from.arguments.size() == wanted) return;
    wrong_node(at, "has " + std::to_string(from.arguments.size()) + " values, '" + from.name +
                       "' must have " + std::to_string(wanted));
  };
  Node node;
  if (from.name == kNumber) {
    count(0);
    node.number = from.number;
    return make_expression(std::move(node));
  }
  if (const auto term = term_named(from.name, node)) {
    node.term = term->term;
    const auto end = std::find(term->members.begin(), term->members.end(), nullptr);
    count(static_cast<std::size_t>(end - term->members.begin()));
    for (std::size_t i = 0; i < from.arguments.size(); ++i) {
      node.*term->members[i] = from.arguments[i];
    }
    if (has_text(node.term)) read_text(from, at, node);
    return make_expression(std::move(node));
  }
  const auto* operation = find(kOperations, [&](const auto& o) { return o.name == from.name; });
  if (operation == nullptr) wrong_node(at, "is '" + from.name + "', which is not an expression");
  count(operation->operands);
  std::vector<Expression> operands;
  for (const int of : from.arguments) {
    if (of < 0 || static_cast<std::size_t>(of) >= at) {
      wrong_node(at, "uses node " + std::to_string(of) + ", which does not come before it");
    }
    operands.push_back(before[static_cast<std::size_t>(of)]);
  }
  return arithmetic(operation->operation, std::move(operands));
}

std::string number_text(double number) {
  std::array<char, 32> out;
  const auto end = std::to_chars(out.data(), out.data() + out.size(), number);
  return {out.data(), end.ptr};
}

// Gives up beyond `size`, and writes "..." for what is nested more than `depth` deep.
class Writer {
 public:
  explicit Writer(std::size_t size) : size_(size) {}

  bool write(const Expression& e, int depth) {
    out.clear();
    add(e, depth, kComparison);
    return out.size() <= size_;
  }
  std::string out;

 private:
  // In parentheses where it binds less tightly than `least`.
  void add(const Expression& e, int depth, int least) {
    if (out.size() > size_) return;
    const Node& node = e.node();
    if (node.term == Term::number) {
      const bool inside = std::signbit(node.number) && kUnary < least;
      out += (inside ? "(" : "") + number_text(node.number) + (inside ? ")" : "");
    } else if (const auto term = term_of(node)) {
      add_term(node, *term);
    } else if (depth < 0) {
      out += "...";
    } else if (node.term == Term::arithmetic) {
      add_operation(node, depth, least);
    } else {
      add_call("function", node, depth);
    }
  }

  void add_term(const Node& node, const TermName& term) {
    out += std::string(term.name) + "(";
    const char* comma = "";
    if (node.term == Term::uniform) {
      out += "'" + node.text + "', '" + to_string(static_cast<Every>(node.of)) + "'";
      out += node.index > 0 ? ", " + std::to_string(node.index) + ")" : ")";
      return;
    }
    if (has_text(node.term)) {
      out += "'" + text_of(node) + "'";
      comma = ", ";
    }
    for (const Member member : term.members) {
      if (member == nullptr) break;
      out += comma;
      const int value = node.*member;
      const ObservedInfo* what = observed_by(node);
      const bool counts = what && info(what->observer).item == ObservedItem::coordinate;
      const bool letter =
          member != kIndex && !counts && !has_text(node.term) && value >= 0 && value < 3;
      out += letter ? std::string("'") + "xyz"[value] + "'" : std::to_string(value);
      comma = ", ";
    }
    out += ")";
  }

  void add_call(std::string_view name, const Node& node, int depth) {
    out += std::string(name) + "(";
    for (std::size_t i = 0; i < node.operands.size(); ++i) {
      if (i > 0) out += ", ";
      add(node.operands[i], depth - 1, kComparison);
    }
    out += ")";
  }

  void add_operation(const Node& node, int depth, int least) {
    const OperationName& operation = name_of(node.operation);
    const Binding binding = operation.binding;
    if (node.operation == Operation::previous) return add_previous(node, depth);
    if (operation.sign.empty()) return add_call(operation.name, node, depth);
    const bool inside = binding < least;
    if (inside) out += "(";
    if (node.operands.size() == 1) {
      out += operation.sign;
      add(node.operands[0], depth - 1, binding);
    } else {
      // Python groups from the left, powers from the right, and chains comparisons.
      const bool from_left = binding != kComparison && binding != kPower;
      add(node.operands[0], depth - 1, from_left ? binding : binding + 1);
      out += " " + std::string(operation.sign) + " ";
      add(node.operands[1], depth - 1, binding == kPower ? kUnary : binding + 1);
    }
    if (inside) out += ")";
  }

  // previous(previous(x)) is delayed(x, 2).
  void add_previous(const Node& node, int depth) {
    int steps = 1;
    const Expression* of = &node.operands[0];
    for (; of->node().term == Term::arithmetic && of->node().operation == Operation::previous;
         of = &of->node().operands[0]) {
      ++steps;
    }
    out += steps == 1 ? "previous(" : "delayed(";
    add(*of, depth - 1, kComparison);
    out += steps == 1 ? ")" : ", " + std::to_string(steps) + ")";
  }

  std::size_t size_;
};

}  // namespace

ExpressionGraph graph_of(std::span<const Expression> roots) {
  Exporter exporter;
  for (const Expression& e : roots) exporter.graph.roots.push_back(exporter.add(e));
  return std::move(exporter.graph);
}

std::vector<Expression> from_graph(const ExpressionGraph& graph) {
  std::vector<Expression> known, out;
  for (const ExpressionGraph::Node& node : graph.nodes) known.push_back(read_node(node, known));
  for (std::size_t i = 0; i < graph.roots.size(); ++i) {
    const int at = graph.roots[i];
    if (at < 0 || static_cast<std::size_t>(at) >= known.size()) {
      throw std::invalid_argument("roots[" + std::to_string(i) + "] is " + std::to_string(at) +
                                  ", must be 0 to " +
                                  std::to_string(static_cast<long>(known.size()) - 1));
    }
    out.push_back(known[static_cast<std::size_t>(at)]);
  }
  return out;
}

std::string text_of(const Expression& expression, std::size_t size) {
  Writer writer(size);
  // Whole, if it fits; else as deep as fits.
  if (writer.write(expression, std::numeric_limits<int>::max())) return writer.out;
  for (int depth = 12; depth > 0; --depth) {
    if (writer.write(expression, depth)) return writer.out;
  }
  writer.write(expression, 0);
  return writer.out;
}

std::string to_string(const Expression& expression) { return text_of(expression, 20000); }

}  // namespace manyworlds
