// Expression graphs (manyworlds/expression_graph.hpp) as plain values of Python, for pickles.
#pragma once

#include <nanobind/nanobind.h>

#include <vector>

#include "manyworlds/expression_graph.hpp"

namespace manyworlds::python {

// (nodes, roots): tuples (name, number or indices...), and a list of integers. Throws ValueError
// for a function of C++.
nanobind::tuple values_of(const std::vector<Expression>& roots);
// Throws TypeError and ValueError, which name the node, for what values_of() does not make.
std::vector<Expression> from_values(nanobind::handle nodes, nanobind::handle roots);

}  // namespace manyworlds::python
