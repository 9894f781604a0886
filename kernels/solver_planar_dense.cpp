// Solver passes of the Planar space in the dense layout.
#include "kernels/solver_tables.hpp"

#include "kernels/constraint/passes.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_solver_planar_dense(kernels::SolverTable<Real>& with, kernels::SolverTable<Real>& without) {
  with = Passes<Planar, true, true>::table();
  without = Passes<Planar, true, false>::table();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
