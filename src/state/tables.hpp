// TablesOf: a Plan's numbers as the kernels want them, and the arrays they point into.
#pragma once

#include <optional>
#include <vector>

#include "kernels/data/tables.hpp"
#include "manyworlds/batch_options.hpp"
#include "src/base/aligned_buffer.hpp"
#include "src/plan/plan_data.hpp"
#include "src/state/constants.hpp"
#include "src/state/joint_tables.hpp"
#include "src/state/tree_tables.hpp"

namespace manyworlds {

template <class Real>
class TablesOf {
 public:
  TablesOf(const PlanData& plan, const BatchOptions& options, int lanes);
  TablesOf(const TablesOf&) = delete;
  TablesOf& operator=(const TablesOf&) = delete;
  const kernels::SceneConstants<Real>& get() const { return tables_; }

 private:
  void add_bodies(const PlanData& plan);
  void add_shapes(const PlanData& plan);
  void add_pairs(const PlanData& plan);
  void add_pair_classes(const PlanData& plan);
  void add_trees(const PlanData& plan);
  void add_options(const PlanData& plan);
  void add_flight(const PlanData& plan);
  void add_solver(const PlanData& plan);

  kernels::SceneConstants<Real> tables_{};
  Constants<Real> constants_;
  const JointTables joints_;
  std::vector<kernels::BodyTable> bodies_;
  std::vector<kernels::ColliderTable> colliders_;
  std::vector<std::int32_t> collider_row_, collider_body_, first_collider_, pair_of_;
  std::vector<kernels::FixedTable<Real>> fixed_;
  std::vector<kernels::PairClass<Real>> classes_;
  std::optional<TreeTables<Real>> trees_;
  AlignedBuffer<Real> fixed_rows_, hulls_, delta_v_rows_, factor_rows_;
};

}  // namespace manyworlds
