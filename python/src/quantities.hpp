// Everything that a batch has an array of, by name: state fields, numbers of the scene, what is
// observed. All arrays are (worlds, items, components), of the worlds of one kind.
#pragma once

#include <string_view>
#include <variant>
#include <vector>

#include "held_batch.hpp"

namespace manyworlds::python {

struct Quantity {
  std::variant<Field, Parameter, Observed> what;
  const char* name;
  const char* group;     // "state", "parameter", "observed"
  const char* observer;  // that an observed one needs ("rays": rays), else ""
  const char* item;      // what has one: "body", "shape", "world", ...
  int items;
  int components;
  const char* unit;
  const char* meaning;
};

const char* word_of(ObservedItem item);
std::vector<Quantity> quantities_of(const Batch& batch, const KindRange& of);
// Throws nanobind::value_error with the known names and the nearest.
const Quantity& find_quantity(const std::vector<Quantity>& all, std::string_view name);

}  // namespace manyworlds::python
