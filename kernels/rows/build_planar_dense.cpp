// Contact rows of the Planar space in the dense layout.
#include "kernels/collide/row_builder.hpp"
#include "kernels/rows/prepare.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

RowBuilder<Planar> planar_dense() { return row_builder_of<Planar, true>(); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
