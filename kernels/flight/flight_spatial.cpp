// Free flight in space; scalar inertias fly as tensors.
#include "kernels/flight/stages.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_flight_spatial(kernels::FlightTable<Real>* tables) {
  tables[static_cast<int>(Isotropic::kKind)] = flight_table<Isotropic>();
  tables[static_cast<int>(Tensor::kKind)] = flight_table<Tensor>();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
