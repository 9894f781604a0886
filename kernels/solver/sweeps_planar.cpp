// Sweeps over contacts in the Planar space.
#include "kernels/solver/sweep.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_sweeps_planar(kernels::SweepTable<Real>& dense, kernels::SweepTable<Real>& rows) {
  dense = Sweeps<Planar, true>::table();
  rows = Sweeps<Planar, false>::table();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
