// Narrow phase of the Planar space in the rows layout.
#include "kernels/rows/narrow_phase.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_collide_planar_rows(kernels::Stage<Real>* collide) {
  fill_narrow_phase<Planar, false>(collide);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
