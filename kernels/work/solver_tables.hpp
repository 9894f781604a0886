// The solver's instantiations, one file each so that they compile side by side.
#pragma once

#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using FillSolver = void(kernels::SolverTable<Real>& out);
FillSolver fill_solver_planar_dense, fill_solver_planar_rows;
FillSolver fill_solver_isotropic_dense, fill_solver_isotropic_rows;
FillSolver fill_solver_tensor_dense, fill_solver_tensor_rows;

using FillSweeps = void(kernels::SweepTable<Real>& dense, kernels::SweepTable<Real>& rows);
FillSweeps fill_sweeps_planar, fill_sweeps_isotropic, fill_sweeps_tensor;
void fill_tree(kernels::TreeStages<Real>& out);
void fill_audits(kernels::EnergyAudit<Real>* tables);     // [inertia]
void fill_impulses(kernels::ImpulseTable<Real>* tables);  // [inertia]

using FillJoints = void(kernels::JointSolver<Real>& dense, kernels::JointSolver<Real>& rows);
FillJoints fill_joints_planar, fill_joints_tensor;
using FillDirect = void(kernels::DirectSolver<Real>& dense, kernels::DirectSolver<Real>& rows);
FillDirect fill_direct_planar, fill_direct_tensor;
// Bytes of what an edge has: its rows, a set of its factors, and what impulses leave at it.
struct EdgeSizes {
  std::size_t rows, factors, pending;
};
EdgeSizes edge_sizes(Planar);
EdgeSizes edge_sizes(Tensor);
using FillFlight = void(kernels::FlightTable<Real>* tables);  // [inertia]
FillFlight fill_flight_planar, fill_flight_spatial;
// Bytes of the rows of a part.
std::size_t part_bytes(Planar);
std::size_t part_bytes(Tensor);

using FillCollide = void(kernels::Stage<Real>* collide);
FillCollide fill_collide_planar, fill_collide_spatial;

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
