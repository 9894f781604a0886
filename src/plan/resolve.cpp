// What Options leave to the plan: the length unit, the speeds that follow from it, how joints are
// solved, substeps, and how stiff contacts are.
#include <string>

#include "src/plan/collision_passes.hpp"
#include "src/plan/impact_sweeps.hpp"
#include "src/plan/joint_method.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/substeps.hpp"
#include "src/scene/length_unit.hpp"

namespace manyworlds {

void resolve_options(PlanData& plan) {
  Options& o = plan.scene.options;
  const auto choose = [&](const char* option, auto& value, auto chosen, const std::string& why) {
    if (value) return;
    value = chosen;
    plan.choices.push_back({option, static_cast<double>(chosen), why});
  };
  const double unit = length_unit_of(plan.scene), slop = slop_of(plan.scene);
  choose("length_unit", o.length_unit, unit, "size of the smallest moving shape, m");
  const double speed = speed_unit(o);
  choose("contact.slop", o.contact.slop, slop, "0.005 length units, m");
  const char* speeds =
      o.gravity.isZero(0) ? "from the length unit, m/s" : "from gravity and the length unit, m/s";
  choose("contact.push_out_speed", o.contact.push_out_speed, 1.5 * speed, speeds);
  choose("sleep.speed", o.sleep.speed, 0.06 * speed, speeds);

  if (!o.joint.method) {
    if (const std::string why = need_of_trees(extremes(plan), *o.length_unit); !why.empty()) {
      choose("joint.method", o.joint.method, JointMethod::tree, why);
      plan.choices.back().name = to_string(*o.joint.method);
    }
  }
  const SubstepChoice substeps = choose_substeps(extremes(plan), *o.length_unit);
  const PassChoice passes = choose_passes(extremes(plan));
  choose("contact.collision_passes", o.contact.collision_passes, passes.passes, passes.why);
  const SweepsChoice impacts = choose_impact_sweeps(plan.scene);
  choose("contact.impact_sweeps", o.contact.impact_sweeps, impacts.sweeps, impacts.why);
  const int n = *o.contact.collision_passes;
  const auto whole = [n](int number) {
    const int up = (number + n - 1) / n * n;
    return up <= kMostSubsteps ? up : kMostSubsteps / n * n;
  };
  if (o.substeps && whole(*o.substeps) != *o.substeps) {
    const std::string why =
        std::to_string(*o.substeps) + " rounded to a multiple of " + std::to_string(n) + " passes";
    o.substeps.reset();
    choose("substeps", o.substeps, whole(*plan.described.options.substeps), why);
  }
  const bool as_is = whole(substeps.substeps) == substeps.substeps;
  choose(
      "substeps", o.substeps, whole(substeps.substeps),
      substeps.why + (as_is ? "" : "; rounded to a multiple of " + std::to_string(n) + " passes"));
  const int stiff = whole(substeps.stiff);
  const double share = contact_share(substeps.depth);
  const bool full = share == kContactShare;
  choose("contact.frequency", o.contact.frequency, share * stiff / o.dt,
         (full ? "a quarter" : short_text(share)) + " of the rate of " + std::to_string(stiff) +
             " substeps per step, Hz" +
             (full ? ""
                   : "; less than a quarter since bodies stand " + std::to_string(substeps.depth) +
                         " deep"));
}

}  // namespace manyworlds
