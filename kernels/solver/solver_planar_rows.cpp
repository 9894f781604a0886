// Solver passes of the Planar space in the rows layout.
#include "kernels/solver/passes.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_solver_planar_rows(kernels::SolverTable<Real>& out) {
  out = Passes<Planar, false>::table();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
