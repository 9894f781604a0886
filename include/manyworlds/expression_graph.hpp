// Expressions as plain data, to store or send them, and as text.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "manyworlds/expression.hpp"

namespace manyworlds {

struct ExpressionGraph {
  struct Node {
    std::string name = {};            // "number", or a term or operation, as in Python
    double number = 0;                // value of a "number"
    std::vector<int> arguments = {};  // indices of a term, or operand nodes of an operation
    std::string text = {};            // name of a random number, level, memory or parameter
  };
  std::vector<Node> nodes = {};  // operands precede their operation
  std::vector<int> roots = {};   // a node for each expression
};

// Shared subexpressions become one node. Throws std::invalid_argument for a lane_function().
ExpressionGraph graph_of(std::span<const Expression> roots);
// Throws std::invalid_argument, which names the node, for a graph that graph_of() cannot return.
std::vector<Expression> from_graph(const ExpressionGraph& graph);

// In Python's syntax. In texts longer than `size` characters, deeply nested subexpressions are
// "...".
std::string text_of(const Expression& expression, std::size_t size);

}  // namespace manyworlds
