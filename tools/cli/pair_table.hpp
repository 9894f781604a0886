// The pairs of shapes of a plan as a table, of `plan` and `model`.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "manyworlds/plan.hpp"

namespace manyworlds::cli {

nlohmann::ordered_json pairs_json(const std::vector<PlanReport::PairClass>& pairs);
void print_pairs(const std::vector<PlanReport::PairClass>& pairs);

// The most characters that name(item) has, and no fewer than `least`: of a column.
template <class Items, class Name>
std::size_t widest(const Items& items, Name name, std::size_t least) {
  std::size_t width = least;
  for (const auto& item : items) width = std::max(width, name(item).size());
  return width;
}

}  // namespace manyworlds::cli
