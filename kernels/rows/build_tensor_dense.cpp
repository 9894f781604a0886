// Contact rows of the Tensor space in the dense layout.
#include "kernels/collide/row_builder.hpp"
#include "kernels/rows/prepare.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

RowBuilder<Isotropic> tensor_dense() { return row_builder_of<Tensor, true>(); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
