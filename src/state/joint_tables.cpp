// Tables of joints on bodies: their parts, the trees of them that are solved at once, thrusts, what
// may break, and which bodies do not collide because of a joint.
#include <algorithm>
#include <cmath>

#include "src/state/tables.hpp"

namespace manyworlds {

template <class Real>
void TablesOf<Real>::add_joints(const PlanData& plan) {
  auto& t = tables_;
  for (const PlanPart& p : plan.parts) parts_.push_back(p.what);
  add_breaking(plan);
  t.parts = static_cast<std::int32_t>(parts_.size());
  t.part = parts_.data();
  for (const kernels::JointPart& part : parts_) {
    if (part.body_a != t.bodies) jointed_.push_back(part.body_a);
    jointed_.push_back(part.body_b);
  }
  std::sort(jointed_.begin(), jointed_.end());
  jointed_.erase(std::unique(jointed_.begin(), jointed_.end()), jointed_.end());
  t.jointed_bodies = static_cast<std::int32_t>(jointed_.size());
  t.jointed = jointed_.data();
  const PlanJointTrees& trees = plan.trees_of_joints;
  edges_ = trees.edges, edge_roots_ = trees.roots, edge_bodies_ = trees.bodies;
  edge_of_ = trees.edge_of, loops_ = trees.loops;
  t.joint_trees = trees.counts;
  t.joint_trees.edge = edges_.data(), t.joint_trees.loop = loops_.data();
  t.joint_trees.root = edge_roots_.data(), t.joint_trees.body = edge_bodies_.data();
  t.joint_trees.edge_of = edge_of_.data();
  t.has_drives = std::any_of(parts_.begin(), parts_.end(), kernels::gives_energy);
  for (const PlanThrust& p : plan.thrusts) thrusts_.push_back(p.what);
  for (int body = 0, i = 0; !thrusts_.empty() && body <= t.bodies; ++body) {
    while (i < static_cast<int>(thrusts_.size()) &&
           thrusts_[static_cast<std::size_t>(i)].body < body)
      ++i;
    first_thrust_.push_back(i);
  }
  t.thrust = thrusts_.data();
  t.first_thrust = first_thrust_.empty() ? nullptr : first_thrust_.data();
  const auto name = [&](int scene_body) {
    const int state_body = plan.state_body[static_cast<std::size_t>(scene_body)];
    return state_body >= 0 ? state_body : t.bodies + 1 + scene_body;
  };
  std::vector<std::vector<std::int32_t>> others(plan.bodies.size());
  for (const auto& [a, b] : joined_bodies(plan.scene)) {
    for (const auto& [one, other] : {std::pair(name(a), name(b)), std::pair(name(b), name(a))}) {
      if (one < t.bodies) others[static_cast<std::size_t>(one)].push_back(other);
    }
  }
  for (const auto& list : others) {
    first_joined_.push_back(static_cast<std::int32_t>(joined_.size()));
    joined_.insert(joined_.end(), list.begin(), list.end());
  }
  first_joined_.push_back(static_cast<std::int32_t>(joined_.size()));
  t.joined = joined_.empty() ? nullptr : joined_.data();
  t.first_joined = first_joined_.data();
}

template <class Real>
void TablesOf<Real>::add_breaking(const PlanData& plan) {
  auto& t = tables_;
  t.joints = static_cast<std::int32_t>(plan.scene.joints.size());
  for (std::size_t i = 0; i < plan.parts.size(); ++i) {
    const Joint& joint = plan.scene.joints[static_cast<std::size_t>(plan.parts[i].joint)];
    if (std::isinf(joint.break_force) && std::isinf(joint.break_torque)) continue;
    if (breaking_.empty() || breaking_.back().joint != plan.parts[i].joint) {
      breaking_.push_back({plan.parts[i].joint, static_cast<std::int32_t>(i), 0});
    }
    ++breaking_.back().parts;
  }
  t.breakable = static_cast<std::int32_t>(breaking_.size());
  t.breaking = breaking_.data();
}

template void TablesOf<float>::add_joints(const PlanData& plan);
template void TablesOf<double>::add_joints(const PlanData& plan);
template void TablesOf<float>::add_breaking(const PlanData& plan);
template void TablesOf<double>::add_breaking(const PlanData& plan);

}  // namespace manyworlds
