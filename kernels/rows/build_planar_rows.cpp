// Contact rows of the Planar space in the rows layout.
#include "kernels/collide/row_builder.hpp"
#include "kernels/rows/prepare.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

RowBuilder<Planar> planar_rows() { return row_builder_of<Planar, false>(); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
