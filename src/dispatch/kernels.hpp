// Which kernel library serves a Batch.
#pragma once

#include <string>

#include "kernels/data/table.hpp"
#include "manyworlds/batch.hpp"

namespace manyworlds {

// The table of an ISA, or nullptr where this build or this CPU has none in this precision.
template <class Real>
const kernels::Kernels<Real>* find_kernels(Isa isa);

// The widest table that is not wider than `isa`; where there is none, the narrowest that is. Throws
// std::invalid_argument when this build or this CPU has none in this precision.
template <class Real>
const kernels::Kernels<Real>& kernels_for(Isa isa);

// Whether there is any.
bool has_kernels(Precision precision);

// Throws std::invalid_argument, with `name` for where it was given, when `isa` cannot be had.
void require_isa(Isa isa, const std::string& name);

}  // namespace manyworlds
