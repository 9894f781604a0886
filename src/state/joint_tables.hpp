// The joints on bodies of a plan as the kernels want them; the same numbers in every precision.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/data/tables.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

class JointTables {
 public:
  explicit JointTables(const PlanData& plan);
  JointTables(const JointTables&) = delete;
  JointTables& operator=(const JointTables&) = delete;

  // Points into this object.
  template <class Real>
  void put(kernels::SceneConstants<Real>& t) const {
    t.joints = joints_;
    t.part = parts_.data(), t.parts = size(parts_);
    t.jointed = jointed_.data(), t.jointed_bodies = size(jointed_);
    t.breaking = breaking_.data(), t.breakable = size(breaking_);
    t.joint_trees = joint_trees_;
    t.has_drives = has_drives_, t.joints_curve = joints_curve_;
    t.thrust = thrusts_.data();
    t.first_thrust = first_thrust_.empty() ? nullptr : first_thrust_.data();
    t.joined = joined_.empty() ? nullptr : joined_.data();
    t.first_joined = first_joined_.data();
  }

 private:
  template <class T>
  static std::int32_t size(const std::vector<T>& v) {
    return static_cast<std::int32_t>(v.size());
  }
  void add_parts(const PlanData& plan);
  void add_breaking(const PlanData& plan);
  void add_trees(const PlanData& plan);
  void add_thrusts(const PlanData& plan);
  void add_joined(const PlanData& plan);

  std::int32_t joints_ = 0;
  std::vector<kernels::JointPart> parts_;
  std::vector<std::int32_t> jointed_;
  std::vector<kernels::BreakTable> breaking_;
  kernels::JointTrees joint_trees_{};
  bool has_drives_ = false, joints_curve_ = false;
  std::vector<kernels::TreeEdge> edges_;
  std::vector<kernels::JointLoops> loops_;
  std::vector<std::int32_t> edge_roots_, edge_bodies_, edge_of_;
  std::vector<kernels::ThrustTable> thrusts_;
  std::vector<std::int32_t> first_thrust_;
  std::vector<std::int32_t> joined_, first_joined_;
};

}  // namespace manyworlds
