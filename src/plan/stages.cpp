// Which stages a plan runs, and why.
#include "src/plan/stages.hpp"

#include <algorithm>

#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

// Bodies in joint coordinates: contact detection is as usual, one stage does the rest of the step.
void choose_tree_stages(PlanData& plan) {
  for (PlanStage& stage : plan.stages) stage = {false, "bodies move in joint coordinates"};
  const bool contacts = plan.has(Feature::contacts);
  const std::string touch = plan.why[static_cast<std::size_t>(Feature::contacts)];
  for (const StepStage stage : {StepStage::begin, StepStage::broad_phase, StepStage::collide}) {
    plan.stages[static_cast<std::size_t>(stage)] = {contacts, touch};
  }
  const auto count = [](std::size_t n, const char* what) { return std::to_string(n) + what; };
  plan.stages[static_cast<std::size_t>(StepStage::tree)] = {
      true, "newton, " + count(plan.trees.links.size(), " links, ") +
                count(plan.trees.dofs.size(), " degrees of freedom, ") +
                count(plan.trees.limits.size() + plan.trees.ball_limits.size(), " limits, ") +
                (plan.trees.by_links ? "solved by articulated bodies"
                                     : "solved by the joint-space inertia")};
}

// How many of the scene's joints are solved in which way.
std::string how_joints_are_solved(const PlanData& plan) {
  int at_once = 0, attached = 0, swept = 0, last = -1;
  for (const PlanPart& part : plan.parts) {
    if (part.joint == last) continue;
    last = part.joint;
    ++(part.what.direct ? at_once : part.what.attached ? attached : swept);
  }
  std::string out = std::to_string(at_once) + " solved at once";
  if (attached > 0) out += ", " + std::to_string(attached) + " attached to these";
  if (swept > 0) out += ", " + std::to_string(swept) + " swept";
  return out;
}

}  // namespace

void choose_stages(PlanData& plan) {
  if (plan.has_trees()) return choose_tree_stages(plan);
  const auto why = [&](Feature f) { return plan.why[static_cast<std::size_t>(f)]; };
  const auto set = [&](StepStage stage, bool in, std::string reason) {
    plan.stages[static_cast<std::size_t>(stage)] = {in, std::move(reason)};
  };
  set(StepStage::tree, false, "bodies are not in joint coordinates");
  const Options& options = plan.scene.options;
  const bool contacts = plan.has(Feature::contacts), flight = has_flight(options);
  const bool forces_only = std::all_of(plan.parts.begin(), plan.parts.end(),
                                       [](const PlanPart& p) { return p.what.force; });
  const bool substeps =
      contacts || (flight ? !forces_only : !plan.parts.empty() || !plan.thrusts.empty());
  const bool joints = substeps && !plan.parts.empty();
  const std::string touch = why(Feature::contacts);
  const std::string some = contacts ? touch
                           : joints ? why(Feature::joints)
                                    : "controls exert forces on bodies";

  set(StepStage::free_motion, !substeps && !flight,
      substeps ? "contacts, joints or controls need substeps"
      : flight ? "another integrator is set"
               : touch);
  set(StepStage::flight, flight,
      flight ? to_string(options.integrator) : "the default integrator is part of the substeps");
  set(StepStage::begin, substeps, substeps ? some : touch);
  set(StepStage::broad_phase, contacts,
      plan.sparse  ? "sort and sweep, no table of pairs"
      : plan.sweep ? "sort and sweep"
                   : "masked all-pairs");
  set(StepStage::collide, contacts, touch);
  set(StepStage::joints, joints,
      plan.has(Feature::joints) && !joints    ? "springs are forces of the integrator"
      : plan.trees_of_joints.counts.edges > 0 ? how_joints_are_solved(plan)
                                              : why(Feature::joints));
  set(StepStage::warm_start, substeps, substeps ? some : touch);

  const std::string solver = to_string(options.solver.method);
  const int sweeps = iterations_of(options.solver);
  set(StepStage::bias, contacts,
      solver + (sweeps == 1 ? ", one sweep per substep"
                            : ", " + std::to_string(sweeps) + " sweeps per substep"));
  set(StepStage::advance, substeps, "displacements, once per substep");
  const bool soft = options.solver.method == Solver::tgs_soft;
  set(StepStage::relax, contacts && soft,
      !soft                         ? solver + " has no relaxation sweep"
      : plan.has(Feature::friction) ? "normal rows and friction, once per substep"
                                    : "normal rows, once per substep");
  set(StepStage::resist, contacts && plan.has(Feature::resistance), why(Feature::resistance));
  set(StepStage::restitute, contacts && plan.has(Feature::restitution), why(Feature::restitution));
  set(StepStage::store, contacts, "impulses for the next step's warm start");
  const bool moving_casts = options.contact.cast_between_moving;
  set(StepStage::finish, substeps,
      !substeps ? "steps without substeps write the state directly"
      : !contacts || !(plan.cast || moving_casts) ? "writes the state"
      : !moving_casts                             ? "writes the state; casts against fixed shapes"
      : !plan.cast                                ? "writes the state; casts between moving shapes"
                   : "writes the state; casts against fixed and between moving shapes");
}

}  // namespace manyworlds
