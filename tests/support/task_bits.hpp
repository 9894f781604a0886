// What a world of a task does, and that it does the same whatever it is stepped with.
#pragma once

#include <catch2/catch.hpp>

#include <vector>

#include "tests/support/policy.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

// All that a world observes in some steps, under random actions, as world `first` + w would.
inline std::vector<float> played(const Task& task, EnvironmentOptions options, int world,
                                 int first = 0) {
  options.seed += static_cast<std::uint64_t>(first);
  Played p(task, options);
  std::vector<float> out;
  const std::size_t n = task.observations.size(), at = static_cast<std::size_t>(world) * n;
  for (int step = 0; step < 30; ++step) {
    p.act_at_random(step, first);
    p.step();
    out.insert(out.end(), p.observations.begin() + static_cast<std::ptrdiff_t>(at),
               p.observations.begin() + static_cast<std::ptrdiff_t>(at + n));
  }
  return out;
}

// Whatever the lane, the batch, threads and the instruction set.
inline void check_same_bits(const Task& task) {
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<float> before;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      EnvironmentOptions options{.worlds = 19, .threads = 1, .seed = 4, .precision = precision};
      options.isa = table.isa;
      const std::vector<float> together = played(task, options, 17);
      options.worlds = 1;
      CHECK(played(task, options, 0, 17) == together);
      options.worlds = 40, options.threads = 2;
      CHECK(played(task, options, 17) == together);
      CHECK((before.empty() || before == together));
      before = together;
    }
  }
}

}  // namespace manyworlds::test
