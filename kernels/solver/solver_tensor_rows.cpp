// Solver passes of the Tensor space in the rows layout.
#include "kernels/solver/passes.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_solver_tensor_rows(kernels::SolverTable<Real>& out) {
  out = Passes<Tensor, false>::table();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
