// The plan for people: what is in, what is out and why, and what it takes.
#include <algorithm>

#include "manyworlds/fields.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

PlanReport describe(const PlanData& plan) {
  PlanReport out;
  for (int i = 0; i < kFeatureCount; ++i) {
    const auto f = static_cast<std::size_t>(i);
    out.features.push_back({to_string(static_cast<Feature>(i)), plan.in[f], plan.why[f]});
  }
  const auto why = [&](Feature f) { return plan.why[static_cast<std::size_t>(f)]; };
  const bool contacts = plan.has(Feature::contacts), bounce = plan.has(Feature::restitution);
  const bool moving_casts = plan.scene.options.cast_between_moving;
  const std::string touch = why(Feature::contacts);
  const bool flight = flies(plan.scene.options);
  const bool only_forces =
      !plan.parts.empty() && std::all_of(plan.parts.begin(), plan.parts.end(),
                                         [](const PlanPart& p) { return p.what.force; });
  const bool joints = plan.has(Feature::joints) && (!only_forces || contacts),
             rows = contacts || joints;
  const std::string some = contacts ? touch : why(Feature::joints);
  const std::string integrator = to_string(plan.scene.options.integrator);
  const Options& options = plan.scene.options;
  const bool soft = options.solver == Solver::tgs_soft;
  const std::string solver = to_string(options.solver),
                    sweeps = iterations_of(options) == 1
                                 ? ", a sweep in every substep"
                                 : ", " + std::to_string(iterations_of(options)) +
                                       " sweeps in every substep";
  out.stages = {{"free_motion", !rows && !flight,
                 rows     ? "rows need the substep loop"
                 : flight ? "bodies fly by another integrator"
                          : touch},
                {"flight", flight, flight ? integrator : "bodies fly as the substeps do"},
                {"begin", rows, some},
                {"broad_phase", contacts,
                 plan.sparse  ? "sort and sweep, no table of pairs"
                 : plan.sweep ? "sort and sweep"
                              : "masked all-pairs"},
                {"collide", contacts, touch},
                {"joints", joints,
                 plan.has(Feature::joints) && !joints ? "springs are forces of the flight"
                                                      : why(Feature::joints)},
                {"warm_start", rows, some},
                {"bias", contacts, solver + sweeps},
                {"advance", rows, "displacement, every substep"},
                {"relax", contacts && soft,
                 !soft                         ? solver + " has no relaxing sweep"
                 : plan.has(Feature::friction) ? "normal rows and friction, every substep"
                                               : "normal rows, every substep"},
                {"restitute", contacts && bounce, why(Feature::restitution)},
                {"store", contacts, "impulses for the next step's warm start"},
                {"finish", true,
                 !contacts || !(plan.cast || moving_casts) ? "commit"
                 : !moving_casts ? "commit, with casts against fixed shapes"
                 : !plan.cast    ? "commit, with casts between moving shapes"
                                 : "commit, with casts against fixed and moving shapes"}};

  for (const PlanClass& c : plan.classes) {
    out.pairs.push_back(
        {to_string(c.kind), is_fixed(c.list) ? "fixed" : "pairs", c.candidates, c.culled});
  }

  const std::size_t bodies = plan.bodies.size();
  const auto field = [&](Field f) {
    const auto n = static_cast<std::size_t>(components(f, plan.scene.space));
    out.arrays.push_back({info(f).name, "[body][" + std::to_string(n) + "]", bodies * n * 4});
  };
  field(Field::position);
  if (plan.has(Feature::orientation)) field(Field::orientation);
  field(Field::linear_velocity);
  field(Field::angular_velocity);
  static constexpr const char* kLists[] = {
      "impulses of pairs, several points", "impulses of pairs, one point",
      "impulses against fixed, several points", "impulses against fixed, one point"};
  for (int l = 0; contacts && l < kernels::kLists; ++l) {
    const int capacity = plan.capacity[static_cast<std::size_t>(l)];
    if (capacity == 0) continue;
    const int row = kernels::cache_row_size(plan.dimension(), static_cast<kernels::ListId>(l));
    const int bytes = (capacity + 2) * row * 4 + (capacity + 1) * 4;
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
