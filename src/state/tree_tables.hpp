// The trees of a plan in the kernels' number type.
#pragma once

#include <vector>

#include "src/plan/trees.hpp"

namespace manyworlds {

template <class Real>
class TreeTables {
 public:
  // Coordinates, and velocities and accelerations of dofs, are rows of a world's state, from these
  // on.
  TreeTables(const PlanTrees& trees, int first_coordinate, int first_dof);

  // Points into this object.
  kernels::TreeTable<Real> get() const;

 private:
  kernels::TreeTable<Real> table_{};
  std::vector<kernels::TreeLink<Real>> links_;
  std::vector<kernels::TreeJoint<Real>> joints_;
  std::vector<kernels::TreeDof> dofs_;
  std::vector<kernels::TreeLimit<Real>> limits_;
  std::vector<kernels::TreeTerm<Real>> terms_;
  std::vector<kernels::TreeBallLimit<Real>> ball_limits_;
  std::vector<kernels::TreeBallSpring> ball_springs_;
  std::vector<kernels::TreeActuator> actuators_;
  std::vector<kernels::TreePair<Real>> pairs_;
  std::vector<std::int32_t> pair_dofs_;
  std::vector<std::uint64_t> ancestors_;
};

}  // namespace manyworlds
