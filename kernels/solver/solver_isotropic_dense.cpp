// Solver passes of the Isotropic space in the dense layout.
#include "kernels/solver/passes.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_solver_isotropic_dense(kernels::SolverTable<Real>& out) {
  out = Passes<Isotropic, true>::table();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
