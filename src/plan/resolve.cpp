// What Options leave to the plan: the length unit, the speeds that follow from it, substeps, and
// how stiff contacts are.
#include <algorithm>
#include <cmath>

#include "src/plan/plan_data.hpp"
#include "src/plan/substeps.hpp"
#include "src/scene/length_unit.hpp"

namespace manyworlds {

namespace {

constexpr double kFrequency = 60;  // Hz, that of four substeps of 1/60 s

// Of all worlds, where numbers of the scene vary: the most.
SubstepChoice most_substeps(const PlanData& plan) {
  SubstepChoice out;
  bool first = true;
  for (const Scene& scene : extremes(plan)) {
    const SubstepChoice here = choose_substeps(scene, *plan.scene.options.length_unit);
    const int stiff = std::max(out.stiff, here.stiff);
    if (first || here.substeps > out.substeps) out = here;
    out.stiff = stiff;
    first = false;
  }
  return out;
}

}  // namespace

void resolve_options(PlanData& plan) {
  Options& o = plan.scene.options;
  const auto choose = [&](const char* option, auto& value, auto chosen, const std::string& why) {
    if (value) return;
    value = chosen;
    plan.choices.push_back({option, static_cast<double>(chosen), why});
  };
  const double unit = length_unit_of(plan.scene), slop = slop_of(plan.scene);
  choose("length_unit", o.length_unit, unit, "size of the smallest shape that moves, m");
  const double speed = speed_unit(o);
  choose("contact.slop", o.contact.slop, slop, "0.005 of the length unit, m");
  choose("contact.push_out_speed", o.contact.push_out_speed, 1.5 * speed,
         o.gravity.isZero(0) ? "by the length unit, m/s" : "by gravity and the length unit, m/s");
  choose("sleep.speed", o.sleep.speed, 0.06 * speed, "as the speed that pushes out, m/s");

  const SubstepChoice substeps = most_substeps(plan);
  const bool follows = !o.substeps && o.solver.method == Solver::tgs_soft;
  choose("substeps", o.substeps, substeps.substeps, substeps.why);
  if (follows) {
    choose("contact.frequency", o.contact.frequency, kContactShare * substeps.stiff / o.dt,
           substeps.stiff == *o.substeps
               ? "a quarter of the substeps' rate, Hz"
               : "a quarter of the rate of " + std::to_string(substeps.stiff) + " substeps, Hz");
  }
  choose("contact.frequency", o.contact.frequency, kFrequency, "as substeps are given, Hz");
}

}  // namespace manyworlds
