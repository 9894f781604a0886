#include "expression_graph.hpp"

#include <limits>
#include <string>

#include "convert.hpp"

namespace manyworlds::python {

namespace {

constexpr int kMin = std::numeric_limits<int>::min(), kMax = std::numeric_limits<int>::max();

ExpressionGraph::Node read_node(nb::handle value, const Place& place) {
  const std::vector<nb::object> parts = read_elements(value, place, -1, "a node of an expression");
  if (parts.empty()) wrong_value(place, "is empty; expected a name and its values");
  ExpressionGraph::Node node;
  node.name = read_text(parts[0], place.element(0));
  if (node.name == "number") {
    if (parts.size() != 2) {
      wrong_value(place,
                  "has " + std::to_string(parts.size() - 1) + " values, 'number' must have 1");
    }
    node.number = read_number(parts[1], place.element(1));
    return node;
  }
  std::size_t first = 1;
  if (parts.size() > 1 && nb::isinstance<nb::str>(parts[1])) {
    node.text = read_text(parts[1], place.element(1));
    first = 2;
  }
  for (std::size_t i = first; i < parts.size(); ++i) {
    node.arguments.push_back(
        static_cast<int>(read_integer(parts[i], place.element(i), kMin, kMax)));
  }
  return node;
}

}  // namespace

nb::tuple values_of(const std::vector<Expression>& roots) {
  const ExpressionGraph graph = graph_of(roots);
  nb::list nodes;
  for (const ExpressionGraph::Node& node : graph.nodes) {
    nb::list out;
    out.append(nb::str(node.name.c_str(), node.name.size()));
    if (node.name == "number") out.append(node.number);
    if (!node.text.empty()) out.append(nb::str(node.text.c_str(), node.text.size()));
    for (const int argument : node.arguments) out.append(argument);
    nodes.append(nb::tuple(out));
  }
  nb::list places;
  for (const int root : graph.roots) places.append(root);
  return nb::make_tuple(nodes, places);
}

std::vector<Expression> from_values(nb::handle nodes, nb::handle roots) {
  const Place node_place{nullptr, "nodes", -1}, root_place{nullptr, "roots", -1};
  ExpressionGraph graph;
  const auto from = read_elements(nodes, node_place, -1, "a list of nodes");
  for (std::size_t i = 0; i < from.size(); ++i) {
    graph.nodes.push_back(read_node(from[i], node_place.element(i)));
  }
  const auto wanted = read_elements(roots, root_place, -1, "a list of integers");
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    graph.roots.push_back(
        static_cast<int>(read_integer(wanted[i], root_place.element(i), 0, kMax)));
  }
  return from_graph(graph);
}

}  // namespace manyworlds::python
