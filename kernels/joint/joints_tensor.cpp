// Passes over joints in the Tensor space.
#include "kernels/joint/passes.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_joints_tensor(kernels::JointSolver<Real>& dense, kernels::JointSolver<Real>& rows) {
  dense = JointPasses<Tensor, true>::table();
  rows = JointPasses<Tensor, false>::table();
}
std::size_t part_bytes(Tensor) { return kPartBytes<Tensor>; }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
