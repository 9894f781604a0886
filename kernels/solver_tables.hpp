// The solver's instantiations, one file each so that they compile side by side.
#pragma once

#include "kernels/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// with / without friction
using FillSolver = void(kernels::SolverTable<Real>& with, kernels::SolverTable<Real>& without);
FillSolver fill_solver_planar_dense, fill_solver_planar_rows;
FillSolver fill_solver_isotropic_dense, fill_solver_isotropic_rows;
FillSolver fill_solver_tensor_dense, fill_solver_tensor_rows;

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
