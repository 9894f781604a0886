// Sweeps over contacts in the Tensor space.
#include "kernels/solver/sweep.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_sweeps_tensor(kernels::SweepTable<Real>& dense, kernels::SweepTable<Real>& rows) {
  dense = Sweeps<Tensor, true>::table();
  rows = Sweeps<Tensor, false>::table();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
