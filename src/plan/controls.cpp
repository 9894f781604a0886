// Controls: which parts and bodies they act on.
#include <algorithm>

#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

bool is_thrust(const Control& c) {
  return c.kind == ControlKind::thrust || c.kind == ControlKind::torque;
}

// The part that a joint's drive is in: a wheel's is its rotation, not its suspension.
bool has_drive_of(const PlanPart& part, const Joint& joint) {
  return part.what.drive && (part.what.kind == kernels::PartKind::angle ||
                             !std::holds_alternative<WheelJoint>(joint.type));
}

}  // namespace

void collect_controls(PlanData& plan) {
  plan.thrusts.clear();
  plan.control_range.clear();
  const std::vector<Control>& controls = plan.scene.controls;
  for (std::size_t i = 0; i < controls.size(); ++i) {
    const Control& c = controls[i];
    const int index = static_cast<int>(i);
    plan.control_range.push_back({c.low, c.high});
    if (c.kind == ControlKind::joint_force) continue;  // trees
    if (is_thrust(c)) {
      const int body = plan.state_body[static_cast<std::size_t>(c.body.index())];
      const PlanBody& b = plan.bodies[static_cast<std::size_t>(body)];
      PlanThrust out;
      out.what = {body, index, c.kind == ControlKind::torque};
      out.point = b.principal.conjugate() * (c.point - b.center);
      out.direction = b.principal.conjugate() * c.direction.normalized();
      plan.thrusts.push_back(out);
      continue;
    }
    for (PlanPart& part : plan.parts) {
      if (part.joint != c.joint.index()) continue;
      if (!has_drive_of(part, plan.scene.at(c.joint))) continue;
      (c.kind == ControlKind::target_position ? part.what.position_control
                                              : part.what.speed_control) = index;
    }
  }
  std::stable_sort(plan.thrusts.begin(), plan.thrusts.end(),
                   [](const auto& a, const auto& b) { return a.what.body < b.what.body; });
}

}  // namespace manyworlds
