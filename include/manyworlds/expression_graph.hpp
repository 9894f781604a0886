// Expressions as plain values, to be stored or sent, and as a line of text, for people.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "manyworlds/expression.hpp"

namespace manyworlds {

struct ExpressionGraph {
  struct Node {
    std::string name = {};            // "number", a term's or an operation's, as Python has them
    double number = 0;                // of "number"
    std::vector<int> arguments = {};  // a term's indices, or the nodes that an operation takes
    std::string text = {};  // of random numbers and levels: their name; of parameters: which one
  };
  std::vector<Node> nodes = {};  // operands before what they make
  std::vector<int> roots = {};   // a node for each expression
};

// What several expressions share is one node. Throws std::invalid_argument for a function of C++.
ExpressionGraph graph_of(std::span<const Expression> roots);
// Throws std::invalid_argument, which names the node, for what graph_of() does not make.
std::vector<Expression> from_graph(const ExpressionGraph& graph);

// As Python writes it. Where it has more than `size` characters, what is nested deeply is "...".
std::string text_of(const Expression& expression, std::size_t size);

}  // namespace manyworlds
