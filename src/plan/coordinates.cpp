// The coordinates of joints, for observers.
#include "src/base/index_check.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

namespace {

using kernels::PartKind;

std::vector<PartKind> kinds(const BallJoint&) { return {PartKind::cone, PartKind::twist}; }
std::vector<PartKind> kinds(const HingeJoint&) { return {PartKind::angle}; }
std::vector<PartKind> kinds(const SliderJoint&) { return {PartKind::slide}; }
std::vector<PartKind> kinds(const FixedJoint&) { return {}; }
std::vector<PartKind> kinds(const DistanceJoint&) { return {PartKind::distance}; }
std::vector<PartKind> kinds(const WheelJoint&) { return {PartKind::slide, PartKind::angle}; }
std::vector<PartKind> kinds(const PulleyJoint&) { return {PartKind::pulley}; }
std::vector<PartKind> kinds(const TargetJoint&) { return {}; }

}  // namespace

void collect_coordinates(PlanData& plan) {
  plan.coordinates.clear();
  plan.first_observed.clear();
  std::size_t part = 0;  // the first of the joint
  for (std::size_t i = 0; i < plan.scene.joints.size(); ++i) {
    plan.first_observed.push_back(static_cast<int>(plan.coordinates.size()));
    const auto of = [](const auto& type) { return kinds(type); };
    for (const PartKind kind : std::visit(of, plan.scene.joints[i].type)) {
      kernels::JointCoordinate& out = plan.coordinates.emplace_back();
      out.what.kind = kind;
      if (plan.has_trees()) continue;  // which joint it is of: collect_trees.cpp
      while (plan.parts[part].joint < static_cast<int>(i)) ++part;
      out.what.body_a = plan.parts[part].what.body_a;
      out.what.body_b = plan.parts[part].what.body_b;
      out.part = static_cast<std::int32_t>(part);
    }
  }
  plan.first_observed.push_back(static_cast<int>(plan.coordinates.size()));
  plan.first_coordinate = plan.first_observed;  // of trees: collect_trees.cpp
}

int Plan::first_coordinate(JointId joint) const {
  check_index("joint", joint.index(), scene().joints.size());
  return data_->first_coordinate[static_cast<std::size_t>(joint.index())];
}
int Plan::first_observed(JointId joint) const {
  check_index("joint", joint.index(), scene().joints.size());
  return data_->first_observed[static_cast<std::size_t>(joint.index())];
}
int Plan::coordinates() const { return static_cast<int>(data_->coordinates.size()); }

}  // namespace manyworlds
