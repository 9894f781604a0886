// What a batch has observed in one world.
#pragma once

#include <cstddef>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::test {

inline std::vector<double> numbers(const Batch& batch, Observed what, int world = 0) {
  std::vector<double> out(batch.size(what) / static_cast<std::size_t>(batch.worlds()));
  batch.read(what, world, out);
  return out;
}

}  // namespace manyworlds::test
