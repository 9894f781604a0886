#include "pair_table.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace manyworlds::cli {

nlohmann::ordered_json pairs_json(const std::vector<PlanReport::PairClass>& pairs) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const auto& pair : pairs) {
    list.push_back({{"kernel", pair.kernel},
                    {"kind", pair.kind},
                    {"candidates", pair.candidates},
                    {"culled", pair.culled}});
  }
  return list;
}

void print_pairs(const std::vector<PlanReport::PairClass>& pairs) {
  fmt::print("\npairs of shapes\n");
  if (pairs.empty()) {
    fmt::print("  none\n");
    return;
  }
  const std::size_t width = widest(
      pairs, [](const auto& pair) { return pair.kernel; }, 6);
  fmt::print("  {:<{}}  {:<7}{:>11}{:>11}\n", "kernel", width, "kind", "candidates", "culled");
  for (const auto& pair : pairs) {
    fmt::print("  {:<{}}  {:<7}{:>11}{:>11}\n", pair.kernel, width, pair.kind, pair.candidates,
               pair.culled);
  }
}

}  // namespace manyworlds::cli
