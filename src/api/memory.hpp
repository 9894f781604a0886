// How much memory a Batch needs, before it asks for it.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds {

// Bytes: worlds, observers, and the scratch of all threads. Good to some percent.
double memory_of(const std::vector<Batch::Kind>& kinds, const BatchOptions& options, Isa isa,
                 int threads);

// Whether it may be more than a machine has: for small batches that need not be worked out.
bool may_be_large(const std::vector<Batch::Kind>& kinds, const BatchOptions& options, int threads);

// "worlds: 5000000 worlds of 'stack10' need 12.3 GB of memory"
std::string memory_text(const std::vector<Batch::Kind>& kinds, double bytes);

}  // namespace manyworlds
