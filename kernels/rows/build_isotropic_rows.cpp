// Contact rows of the Isotropic space in the rows layout.
#include "kernels/collide/row_builder.hpp"
#include "kernels/rows/prepare.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

RowBuilder<Isotropic> isotropic_rows() { return row_builder_of<Isotropic, false>(); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
