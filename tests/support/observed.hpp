// Batches that observe, and what they have seen in one world.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "manyworlds/batch.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

inline BatchOptions observing(const Table& table, std::vector<Observer> what, int worlds = 1) {
  BatchOptions options = options_of(table, worlds);
  options.observe.what = std::move(what);
  return options;
}

inline std::vector<double> numbers(const Batch& batch, Observed what, int world = 0) {
  std::vector<double> out(batch.size(what) / static_cast<std::size_t>(batch.worlds()));
  batch.read(what, world, out);
  return out;
}

}  // namespace manyworlds::test
