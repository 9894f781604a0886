// Which kernel library serves a Batch.
#pragma once

#include "kernels/table.hpp"
#include "manyworlds/batch.hpp"

namespace manyworlds {

// The table of an ISA, or nullptr where this build or this CPU has none in this precision.
template <class Real>
const kernels::KernelTable<Real>* find_kernels(Isa isa);

// The widest table that is not wider than `isa`. Never nullptr: scalar is always built.
template <class Real>
const kernels::KernelTable<Real>& kernels_for(Isa isa);

}  // namespace manyworlds
