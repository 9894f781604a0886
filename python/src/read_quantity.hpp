// Reading any quantity of a batch, without Python.
#pragma once

#include <span>
#include <stdexcept>
#include <type_traits>

#include "quantities.hpp"

namespace manyworlds::python {

template <class Number>
void read_quantity(const Batch& batch, const Quantity& q, std::span<Number> out) {
  std::visit(
      [&]<class What>(What what) {
        if constexpr (std::is_same_v<What, Parameter> && !std::is_same_v<Number, double>) {
          throw std::invalid_argument("parameters are float64");
        } else {
          batch.read(what, out);
        }
      },
      q.what);
}

}  // namespace manyworlds::python
