#include "src/state/joint_tables.hpp"

#include <algorithm>
#include <cmath>

namespace manyworlds {

JointTables::JointTables(const PlanData& plan)
    : joints_(static_cast<std::int32_t>(plan.scene.joints.size())) {
  add_parts(plan);
  add_breaking(plan);
  add_trees(plan);
  add_thrusts(plan);
  add_joined(plan);
}

void JointTables::add_parts(const PlanData& plan) {
  const auto world = static_cast<std::int32_t>(plan.bodies.size());
  for (const PlanPart& p : plan.parts) parts_.push_back(p.what);
  for (const kernels::JointPart& part : parts_) {
    if (part.body_a != world) jointed_.push_back(part.body_a);
    jointed_.push_back(part.body_b);
  }
  std::sort(jointed_.begin(), jointed_.end());
  jointed_.erase(std::unique(jointed_.begin(), jointed_.end()), jointed_.end());
  has_drives_ = std::any_of(parts_.begin(), parts_.end(), kernels::gives_energy);
  joints_curve_ = std::any_of(parts_.begin(), parts_.end(),
                              [](const kernels::JointPart& part) { return part.curved; });
}

void JointTables::add_breaking(const PlanData& plan) {
  for (std::size_t i = 0; i < plan.parts.size(); ++i) {
    const Joint& joint = plan.scene.joints[static_cast<std::size_t>(plan.parts[i].joint)];
    if (std::isinf(joint.break_force) && std::isinf(joint.break_torque)) continue;
    if (breaking_.empty() || breaking_.back().joint != plan.parts[i].joint) {
      breaking_.push_back({plan.parts[i].joint, static_cast<std::int32_t>(i), 0});
    }
    ++breaking_.back().parts;
  }
}

void JointTables::add_trees(const PlanData& plan) {
  const PlanJointTrees& trees = plan.trees_of_joints;
  edges_ = trees.edges, edge_roots_ = trees.roots, edge_bodies_ = trees.bodies;
  edge_of_ = trees.edge_of, loops_ = trees.loops;
  joint_trees_ = trees.counts;
  joint_trees_.edge = edges_.data(), joint_trees_.loop = loops_.data();
  joint_trees_.root = edge_roots_.data(), joint_trees_.body = edge_bodies_.data();
  joint_trees_.edge_of = edge_of_.data();
}

void JointTables::add_thrusts(const PlanData& plan) {
  for (const PlanThrust& p : plan.thrusts) thrusts_.push_back(p.what);
  if (thrusts_.empty()) return;
  const auto bodies = static_cast<std::int32_t>(plan.bodies.size());
  for (std::int32_t body = 0, i = 0; body <= bodies; ++body) {
    while (i < size(thrusts_) && thrusts_[static_cast<std::size_t>(i)].body < body) ++i;
    first_thrust_.push_back(i);
  }
}

void JointTables::add_joined(const PlanData& plan) {
  const auto bodies = static_cast<std::int32_t>(plan.bodies.size());
  const auto name = [&](int scene_body) {
    const int state_body = plan.state_body[static_cast<std::size_t>(scene_body)];
    return state_body >= 0 ? state_body : bodies + 1 + scene_body;
  };
  std::vector<std::vector<std::int32_t>> others(plan.bodies.size());
  for (const auto& [a, b] : joined_bodies(plan.scene)) {
    for (const auto& [one, other] : {std::pair(name(a), name(b)), std::pair(name(b), name(a))}) {
      if (one < bodies) others[static_cast<std::size_t>(one)].push_back(other);
    }
  }
  for (const auto& list : others) {
    first_joined_.push_back(size(joined_));
    joined_.insert(joined_.end(), list.begin(), list.end());
  }
  first_joined_.push_back(size(joined_));
}

}  // namespace manyworlds
