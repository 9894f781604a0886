// Numbers of trees that may differ from world to world: for a plan, and for that of one world.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "src/plan/plan_data.hpp"
#include "src/scene/joint_numbers.hpp"

namespace manyworlds {

const SoftContact& PlanMaterial::in(const Scene& scene) const {
  return scene.bodies[static_cast<std::size_t>(body)]
      .shapes[static_cast<std::size_t>(shape)]
      .material.soft;
}

kernels::LinkConstants<double> link_numbers(const Vec3& center, const Quat& principal) {
  const Quat q = principal.normalized();
  return {{center.x(), center.y(), center.z()}, {q.w(), q.x(), q.y(), q.z()}};
}

kernels::LimitConstants<double> limit_numbers(double end, const Compliance& compliance, double dt) {
  return {end, compile(compliance, dt)};
}

kernels::ActuatorConstants<double> actuator_numbers(const Actuator& actuator) {
  kernels::ActuatorConstants<double> out{};
  std::copy_n(actuator.gain.data(), 3, out.gain);
  std::copy_n(actuator.bias.data(), 3, out.bias);
  out.gear = actuator.gear, out.low = actuator.low, out.high = actuator.high;
  return out;
}

kernels::DragConstants<double> drag_numbers(const Medium& medium, double mass,
                                            const Vec3& moments) {
  constexpr double kMinMoment = 1e-15;  // kg m^2
  Vec3 box;                             // of the same mass and moments, m
  for (int i = 0; i < 3; ++i) {
    const double square = moments.sum() - 2 * moments[i];
    box[i] = std::sqrt(std::max(square, kMinMoment) / mass * 6);
  }
  kernels::DragConstants<double> out{};
  const double size = box.mean(), viscous = std::numbers::pi * size * medium.viscosity;
  out.viscous = 3 * viscous, out.spin_viscous = viscous * size * size;
  for (int i = 0; i < 3; ++i) {
    const double a = box[(i + 1) % 3], b = box[(i + 2) % 3];
    out.speed[i] = medium.density * a * b / 2;
    out.spin[i] = medium.density * box[i] * (std::pow(a, 4) + std::pow(b, 4)) / 64;
  }
  return out;
}

// Not the weights of rows, which are the plan's: MuJoCo's stay, too, when masses are written into
// a model.
void number_trees(PlanData& plan) {
  PlanTrees& trees = plan.trees;
  const Medium& medium = plan.scene.options.medium;
  for (std::size_t i = 0; plan.varies.links && i < trees.links.size(); ++i) {
    const PlanBody& b = plan.bodies[static_cast<std::size_t>(trees.links[i].body)];
    trees.link_numbers[i] = link_numbers(b.center, b.principal);
    if (!trees.drags.empty()) trees.drags[i] = drag_numbers(medium, b.mass, b.inertia);
  }
  for (std::size_t j = 0; plan.varies.dofs && j < trees.joints.size(); ++j) {
    if (trees.scene_joints[j] < 0) continue;
    const JointDynamics& d =
        plan.scene.joints[static_cast<std::size_t>(trees.scene_joints[j])].dynamics;
    const auto first = static_cast<std::ptrdiff_t>(trees.joints[j].dof);
    std::fill_n(trees.dof_numbers.begin() + first, kernels::dofs_of(trees.joints[j].kind),
                kernels::DofConstants<double>{d.armature, d.damping, d.stiffness, d.rest});
  }
  for (std::size_t i = 0; plan.varies.actuators && i < trees.actuators.size(); ++i) {
    const auto control = static_cast<std::size_t>(trees.actuators[i].control);
    trees.actuator_numbers[i] = actuator_numbers(plan.scene.controls[control].actuator);
  }
  const double h = plan.scene.options.dt / *plan.scene.options.substeps;
  for (std::size_t i = 0; plan.varies.limits && i < trees.limit_numbers.size(); ++i) {
    if (trees.limited_joints[i] < 0) continue;
    const int joint = trees.scene_joints[static_cast<std::size_t>(trees.limited_joints[i])];
    const Limit& limit = *limit_of(plan.scene.joints[static_cast<std::size_t>(joint)].type);
    const bool lower = i < trees.limits.size() && trees.limits[i].side > 0;
    trees.limit_numbers[i] = limit_numbers(lower ? limit.low : limit.high, limit.compliance, h);
  }
  for (std::size_t i = 0; i < trees.mixed.size(); ++i) {
    const auto& [a, b] = trees.mixed[i];
    trees.compliances[i] = compile(mixed_compliance(a.in(plan.scene), b.in(plan.scene)), h);
  }
}

}  // namespace manyworlds
