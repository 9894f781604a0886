// The trees of a plan in the kernels' number type.
#pragma once

#include <vector>

#include "src/plan/trees.hpp"

namespace manyworlds {

template <class Real>
class TreeTables {
 public:
  // Coordinates, velocities and accelerations are rows of a world's state, from these on.
  TreeTables(const PlanTrees& trees, int first_coordinate, int first_velocity,
             int first_acceleration);

  // Points into this object.
  kernels::TreeTable<Real> get() const;

 private:
  kernels::TreeTable<Real> table_{};
  std::vector<kernels::TreeLink<Real>> links_;
  std::vector<kernels::TreeJoint<Real>> joints_;
  std::vector<kernels::TreeDof<Real>> dofs_;
  std::vector<kernels::TreeLimit<Real>> limits_;
};

}  // namespace manyworlds
