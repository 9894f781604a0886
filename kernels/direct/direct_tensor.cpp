// Solves over trees of joints in the Tensor space.
#include "kernels/direct/passes.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_direct_tensor(kernels::DirectSolver<Real>& dense, kernels::DirectSolver<Real>& rows) {
  dense = DirectPasses<Tensor, true>::table();
  rows = DirectPasses<Tensor, false>::table();
}
EdgeSizes edge_sizes(Tensor) {
  return {sizeof(EdgeRows<Tensor>), sizeof(EdgeFactors<Tensor>), sizeof(PendingRows<Tensor>)};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
