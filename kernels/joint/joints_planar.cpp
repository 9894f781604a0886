// Passes over joints in the Planar space.
#include "kernels/joint/passes.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_joints_planar(kernels::JointSolver<Real>& dense, kernels::JointSolver<Real>& rows) {
  dense = JointPasses<Planar, true>::table();
  rows = JointPasses<Planar, false>::table();
}
std::size_t part_bytes(Planar) { return kPartBytes<Planar>; }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
