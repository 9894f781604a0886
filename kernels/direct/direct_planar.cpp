// Solves over trees of joints in the Planar space.
#include "kernels/direct/passes.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_direct_planar(kernels::DirectSolver<Real>& dense, kernels::DirectSolver<Real>& rows) {
  dense = DirectPasses<Planar, true>::table();
  rows = DirectPasses<Planar, false>::table();
}
EdgeSizes edge_sizes(Planar) {
  return {sizeof(EdgeRows<Planar>), sizeof(EdgeFactors<Planar>), sizeof(PendingRows<Planar>)};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
