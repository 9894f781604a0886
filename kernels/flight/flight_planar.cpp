// Free flight in the plane.
#include "kernels/flight/stages.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void fill_flight_planar(kernels::FlightTable<Real>* tables) {
  tables[static_cast<int>(Planar::kKind)] = flight_table<Planar>();
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
