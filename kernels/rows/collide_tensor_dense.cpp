// Narrow phase of the Tensor space in the dense layout.
#include "kernels/rows/narrow_phase.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_collide_tensor_dense(kernels::Stage<Real>* collide) {
  fill_narrow_phase<Tensor, true>(collide);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
