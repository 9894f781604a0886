// What varies from world to world, and the plan of one world's own numbers.
#include <algorithm>

#include "src/plan/plan_data.hpp"

namespace manyworlds {

void collect_variations(PlanData& plan) {
  plan.varied = varied_numbers(plan.scene);
  PlanVaries& varies = plan.varies;
  for (const VariedNumber& n : plan.varied) {
    switch (n.parameter) {
      case Parameter::size:
      case Parameter::shape_position:
      case Parameter::shape_rotation:
        varies.shapes = varies.masses = true;
        varies.links = plan.has_trees();
        break;
      case Parameter::density: {
        const Body& body = plan.scene.bodies[static_cast<std::size_t>(n.of.body)];
        const bool several = body.shapes.size() > 1;  // about the centre of mass
        varies.masses = true;
        varies.shapes = varies.shapes || several;
        varies.links = varies.links || (several && plan.has_trees());
        break;
      }
      case Parameter::mass: varies.masses = true; break;
      case Parameter::friction:
      case Parameter::restitution:
      case Parameter::rolling_resistance:
      case Parameter::torsional_resistance: varies.materials = true; break;
      case Parameter::gravity:
      case Parameter::gravity_scale: varies.delta_v = true; break;
      case Parameter::linear_drag:
        varies.delta_v = varies.delta_v || !plan.scene.options.wind.isZero(0);
        [[fallthrough]];
      case Parameter::angular_drag: varies.drag = true; break;
      case Parameter::armature:
      case Parameter::damping:
      case Parameter::stiffness:
      case Parameter::rest: varies.dofs = true; break;
      case Parameter::gain:
      case Parameter::bias:
      case Parameter::kp:
      case Parameter::kv:
      case Parameter::gear:
      case Parameter::force_low:
      case Parameter::force_high: varies.actuators = true; break;
      case Parameter::limit_solref:
      case Parameter::limit_solimp: varies.limits = true; break;
      case Parameter::contact_solref:
      case Parameter::contact_solimp: varies.contacts = true; break;
      case Parameter::limit_low:
      case Parameter::limit_high: (plan.has_trees() ? varies.limits : varies.joints) = true; break;
      case Parameter::motor_speed:
      case Parameter::motor_force:
      case Parameter::drive_stiffness:
      case Parameter::drive_damping:
      case Parameter::drive_frequency:
      case Parameter::drive_damping_ratio:
      case Parameter::motor_position:
      case Parameter::limit_stiffness:
      case Parameter::limit_damping:
      case Parameter::limit_frequency:
      case Parameter::limit_damping_ratio:
      case Parameter::spring_stiffness:
      case Parameter::spring_damping:
      case Parameter::spring_frequency:
      case Parameter::spring_damping_ratio:
      case Parameter::length:
      case Parameter::cone:
      case Parameter::pulley_ratio:
      case Parameter::break_force:
      case Parameter::break_torque:
      case Parameter::anchor_a:
      case Parameter::anchor_b:
      case Parameter::axes_a:
      case Parameter::axes_b: varies.joints = true; break;
      case Parameter::control_point:
      case Parameter::control_direction: varies.thrusts = true; break;
      case Parameter::initial_position:
      case Parameter::initial_rotation:
        // Lengths of joints and how far they are apart are those at the beginning.
        varies.joints = varies.joints || !plan.scene.joints.empty();
        [[fallthrough]];
      case Parameter::initial_linear_velocity:
      case Parameter::initial_angular_velocity: varies.starts = true; break;
      case Parameter::center_of_mass: varies.shapes = true; [[fallthrough]];
      case Parameter::inertia_scale:
        varies.masses = true;
        varies.links = plan.has_trees();
        break;
      case Parameter::wind: varies.delta_v = true; break;
      case Parameter::attractor_position:
      case Parameter::attractor_strength: varies.attractors = true; break;
      case Parameter::control_low:
      case Parameter::control_high: varies.ranges = true; break;
    }
  }
}

void derive_again(PlanData& plan) {
  if (plan.varies.masses || plan.varies.shapes) {
    plan.bodies.clear();
    plan.state_body.clear();
    plan.colliders.clear();
    collect_bodies(plan);
    collect_colliders(plan);
  }
  if (plan.varies.masses || plan.varies.shapes || plan.varies.joints || plan.varies.thrusts) {
    collect_joints(plan);
    collect_controls(plan);
  }
  if (plan.has_trees()) number_trees(plan);
  const auto material = [&](const auto& shape) {
    return plan.scene.bodies[static_cast<std::size_t>(shape.scene_body)]
        .shapes[static_cast<std::size_t>(shape.shape)]
        .material;
  };
  if (!plan.varies.materials) return;
  for (PlanCollider& c : plan.colliders) c.material = material(c);
  for (PlanFixed& f : plan.fixed) f.material = material(f);
}

std::vector<Scene> extremes(const PlanData& plan) {
  std::vector<Scene> out{plan.scene};
  if (plan.varied.empty()) return out;
  for (const bool high : {false, true}) {
    std::vector<double> values;
    for (const VariedNumber& n : plan.varied) values.push_back(high ? n.high : n.low);
    out.push_back(plan.scene);
    set_numbers(out.back(), plan.varied, values.data());
  }
  return out;
}

}  // namespace manyworlds
