// What the kernels know of the solver of a plan (include/manyworlds/solver.hpp).
#pragma once

#include <cstdint>

namespace manyworlds::kernels {

enum class Solver : std::int32_t { tgs_soft, sequential_impulse, sor, nncg, penalty, newton };

template <class Real>
struct SolverOptions {
  Solver kind;
  std::int32_t iterations;
  Real relaxation;      // factor of a row's change
  bool relaxes;         // which is not 1
  bool splits;          // overlaps are removed by displacements
  Real push_out_share;  // of an overlap that a substep removes then
  Real slop;            // m, of overlap that hard rows leave alone
};

}  // namespace manyworlds::kernels
