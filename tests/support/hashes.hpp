// Hashes of worlds: equal exactly when their bits are.
#pragma once

#include <cstdint>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::test {

// [world]
inline std::vector<std::uint64_t> hashes(const Batch& batch) {
  std::vector<std::uint64_t> out;
  for (int w = 0; w < batch.worlds(); ++w) out.push_back(batch.hash(w));
  return out;
}
inline std::vector<std::uint64_t> hashes_after(const Plan& plan, const BatchOptions& options,
                                               int steps) {
  Batch batch(plan, options);
  batch.step(steps);
  return hashes(batch);
}

}  // namespace manyworlds::test
