// Solver passes of the Isotropic space in the rows layout.
#include "kernels/solver_tables.hpp"

#include "kernels/constraint/passes.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_solver_isotropic_rows(kernels::SolverTable<Real>& with, kernels::SolverTable<Real>& without) {
  with = Passes<Isotropic, false, true>::table();
  without = Passes<Isotropic, false, false>::table();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
