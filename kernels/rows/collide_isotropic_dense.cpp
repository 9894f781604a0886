// Narrow phase of the Isotropic space in the dense layout.
#include "kernels/rows/narrow_phase.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_collide_isotropic_dense(kernels::Stage<Real>* collide) {
  fill_narrow_phase<Isotropic, true>(collide);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
