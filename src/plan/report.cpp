// The report of a plan: which stages and features it has and why, and its memory.
#include "kernels/data/group.hpp"
#include "manyworlds/fields.hpp"
#include "src/plan/state_layout.hpp"

namespace manyworlds {

PlanReport describe(const PlanData& plan) {
  PlanReport out;
  out.choices = plan.choices;
  for (int i = 0; i < kFeatureCount; ++i) {
    const auto f = static_cast<std::size_t>(i);
    out.features.push_back({to_string(static_cast<Feature>(i)), plan.in[f], plan.why[f]});
  }
  for (std::size_t i = 0; i < plan.stages.size(); ++i) {
    out.stages.push_back({kStepStageNames[i], plan.stages[i].in, plan.stages[i].why});
  }
  for (const PlanClass& c : plan.classes) {
    out.pairs.push_back(
        {to_string(c.kind), is_fixed(c.list) ? "fixed" : "pairs", c.candidates, c.culled});
  }

  const StateLayout layout = state_layout(plan);
  for (const Field field : kFields) {
    if (!layout.has(field)) continue;
    const ItemKind item = info(field).item;
    const int n = components(field, plan.scene.space);
    out.arrays.push_back({info(field).name,
                          "[" + std::string(to_string(item)) + "][" + std::to_string(n) + "]",
                          static_cast<std::size_t>(item_count(item, plan) * n) * 4});
  }
  static constexpr const char* kLists[] = {
      "impulses of pairs, several points", "impulses of pairs, one point",
      "impulses of fixed shapes, several points", "impulses of fixed shapes, one point"};
  const bool stores = plan.has(Feature::contacts) && !plan.has_trees();
  for (int l = 0; stores && l < kernels::kLists; ++l) {
    const int capacity = plan.capacity[static_cast<std::size_t>(l)];
    if (capacity == 0) continue;
    const int row = kernels::cache_row_size(plan.dimension(), static_cast<kernels::ListId>(l),
                                            plan.has(Feature::resistance));
    const int bytes = (capacity + kernels::kFirstRow) * row * 4 + (capacity + 1) * 4;
    out.arrays.push_back({kLists[l],
                          "[" + std::to_string(capacity) + "][" + std::to_string(row) + "] + keys",
                          static_cast<std::size_t>(bytes)});
    (is_fixed(static_cast<kernels::ListId>(l)) ? out.fixed_capacity : out.pair_capacity) +=
        capacity;
  }
  if (!plan.parts.empty()) {
    out.arrays.push_back({"impulses of joints", "[" + std::to_string(plan.parts.size()) + "][3]",
                          plan.parts.size() * kernels::kPartImpulses * 4});
  }
  out.arrays.push_back({"status", "[1]", 4});
  for (const auto& a : out.arrays) out.bytes_per_world += a.bytes_per_world;
  out.broad_phase = plan.sparse  ? BroadPhase::sparse
                    : plan.sweep ? BroadPhase::sort_and_sweep
                                 : BroadPhase::all_pairs;
  return out;
}

}  // namespace manyworlds
