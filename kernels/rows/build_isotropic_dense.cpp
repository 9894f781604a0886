// Contact rows of the Isotropic space in the dense layout.
#include "kernels/collide/row_builder.hpp"
#include "kernels/rows/prepare.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

RowBuilder<Isotropic> isotropic_dense() { return row_builder_of<Isotropic, true>(); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
