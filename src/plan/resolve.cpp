// What Options leave to the plan: the length unit, the speeds that follow from it, how joints are
// solved, substeps, and how stiff contacts are.
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "src/plan/joint_trees.hpp"
#include "src/plan/plan_data.hpp"
#include "src/plan/substeps.hpp"
#include "src/scene/length_unit.hpp"

namespace manyworlds {

namespace {

// Whether all joints are of trees, and each tree hangs on something: then there are as many joints
// as bodies that have some.
bool all_anchored(const Scene& scene) {
  if (!all_in_trees(scene)) return false;
  std::set<int> bodies;
  for (const Joint& joint : scene.joints) {
    for (const BodyId body : {joint.body_a, joint.body_b}) {
      if (body && scene.at(body).motion == Motion::dynamic) bodies.insert(body.index());
    }
  }
  return bodies.size() == scene.joints.size();
}

// Why joints are solved at once, if they are. Contacts do not know of trees: where something may
// touch, a load on light legs would rest on contacts of the legs' own mass. Free trees spin down by
// their geometric stiffness (kernels/direct/stiffness.hpp). Otherwise sweeps are faster, as long as
// four substeps do, and no fixed joint holds a lever.
std::string need_of_trees(const PlanData& plan) {
  const Scene& scene = plan.scene;
  const Options& o = scene.options;
  if (scene.joints.empty() || o.solver.method != Solver::tgs_soft || o.joint.frequency) return {};
  if (!all_anchored(scene)) return {};
  std::string why;
  const SubstepNeed need = need_of_joints(extremes(plan), *o.length_unit);
  if (need.substeps > kLeastSubsteps) why = "at once, since " + need.why;
  for (std::size_t j = 0; why.empty() && j < scene.joints.size(); ++j) {
    if (std::holds_alternative<FixedJoint>(scene.joints[j].type)) {
      why = "at once, since joint " + std::to_string(j) + " is fixed";
    }
  }
  return !why.empty() && nothing_touches(scene) ? why : std::string();
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

  if (!o.joint.method) {
    if (const std::string why = need_of_trees(plan); !why.empty()) {
      choose("joint.method", o.joint.method, JointMethod::tree, why);
      plan.choices.back().name = to_string(*o.joint.method);
    }
  }
  const SubstepChoice substeps = choose_substeps(extremes(plan), *o.length_unit);
  choose("substeps", o.substeps, substeps.substeps, substeps.why);
  choose("contact.frequency", o.contact.frequency, kContactShare * substeps.stiff / o.dt,
         "a quarter of the rate of " + std::to_string(substeps.stiff) + " substeps, Hz");
}

}  // namespace manyworlds
