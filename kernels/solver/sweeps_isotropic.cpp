// Sweeps over contacts in the Isotropic space.
#include "kernels/solver/sweep.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_sweeps_isotropic(kernels::SweepTable<Real>& dense, kernels::SweepTable<Real>& rows) {
  dense = Sweeps<Isotropic, true>::table();
  rows = Sweeps<Isotropic, false>::table();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
