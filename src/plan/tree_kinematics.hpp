// Where the links of trees are, and how their dofs move them, in double: for what begins a world
// and for weights. The step has its own (kernels/tree/kinematics.hpp).
#pragma once

#include <span>

#include "src/plan/trees.hpp"

namespace manyworlds {

// How fast a dof of unit velocity moves a point, and rotates; world axes.
struct DofMotion {
  Vec3 axis = Vec3::Zero(), direction = Vec3::Zero(), point = Vec3::Zero();
  Vec3 velocity(const Vec3& at) const { return direction + axis.cross(at - point); }
};

struct TreeKinematics {
  std::vector<Quat> rotation;      // [link], of its frame
  std::vector<Vec3> origin;        // [link], of its frame, world
  std::vector<Vec3> center;        // [link], of mass as the plan has it, world
  std::vector<DofMotion> motions;  // [dof]
};

// Rotations among the coordinates need not be unit.
TreeKinematics kinematics_of(const PlanTrees& trees, std::span<const double> coordinates);
std::vector<double> reference_coordinates(const PlanTrees& trees);

// Calls visit(dof) for all that move the link, from its own to the root's.
template <class Visit>
void for_each_dof_of(const PlanTrees& trees, std::size_t link, Visit visit) {
  for (int i = static_cast<int>(link); i >= 0;
       i = trees.links[static_cast<std::size_t>(i)].parent) {
    const auto& l = trees.links[static_cast<std::size_t>(i)];
    for (int k = l.first_dof + l.dofs - 1; k >= l.first_dof; --k)
      visit(static_cast<std::size_t>(k));
  }
}

}  // namespace manyworlds
