// Contact rows of the Tensor space in the rows layout.
#include "kernels/collide/row_builder.hpp"
#include "kernels/rows/prepare.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

RowBuilder<Isotropic> tensor_rows() { return row_builder_of<Tensor, false>(); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
