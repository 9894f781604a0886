// Solves over trees of joints in the Tensor space.
#include "kernels/direct/passes.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_direct_tensor(kernels::DirectSolver<Real>& dense, kernels::DirectSolver<Real>& rows) {
  dense = DirectPasses<Tensor, true>::table();
  rows = DirectPasses<Tensor, false>::table();
}
std::size_t edge_bytes(Tensor) { return sizeof(EdgeRows<Tensor>); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
