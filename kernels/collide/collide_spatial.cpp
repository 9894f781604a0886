// Narrow phase of space.
#include "kernels/collide/narrow_phase.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_collide_spatial(kernels::Stage<Real>* collide) { fill_narrow_phase<Isotropic>(collide); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
