// Narrow phase of the plane.
#include "kernels/collide/narrow_phase.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_collide_planar(kernels::Stage<Real>* collide) { fill_narrow_phase<Planar>(collide); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
