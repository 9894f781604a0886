// The law of bits for trees of joints that are solved at once.
#pragma once

#include <cstring>
#include <vector>

#include <catch2/catch.hpp>

#include "manyworlds/batch.hpp"
#include "tests/support/tables.hpp"

namespace manyworlds::test {

inline bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

// Worlds move by the same bits in every instruction set and layout, by any number of threads, and
// among others as alone. In every fourth one of `off` is disabled.
inline void check_same_bits(const Plan& plan, const std::vector<JointId>& off) {
  REQUIRE(plan.resolved().joint.method == JointMethod::tree);
  for (const Precision precision : {Precision::f32, Precision::f64}) {
    std::vector<std::uint64_t> reference;
    for (const Table& table : all_tables()) {
      if (table.precision != precision) continue;
      for (const ContactLayout layout : {ContactLayout::dense, ContactLayout::rows}) {
        for (const int threads : {1, 3}) {
          BatchOptions options = options_of(table, 21, threads);
          options.layout = layout;
          Batch batch(plan, options);
          for (std::size_t w = 0; w < 21; w += 4) {
            batch.set_joint_enabled(static_cast<int>(w), off[w / 4 % off.size()], false);
          }
          batch.step(60);
          std::vector<std::uint64_t> hashes;
          for (int w = 0; w < 21; ++w) {
            CHECK(batch.status(w) == Status::ok);
            hashes.push_back(batch.hash(w));
          }
          if (reference.empty()) reference = hashes;
          INFO(name(table) << " threads " << threads);
          CHECK(hashes == reference);
        }
      }
    }
    if (reference.empty()) continue;
    CHECK(reference[0] != reference[1]);
    BatchOptions alone = options_of({Isa::scalar, precision}, 1);
    for (const int w : {1, 6, 18}) {
      alone.seed = options_of({Isa::scalar, precision}, 1).seed + static_cast<std::uint64_t>(w);
      Batch batch(plan, alone);
      batch.step(60);
      CHECK(batch.hash(0) == reference[static_cast<std::size_t>(w)]);
    }
  }
}

}  // namespace manyworlds::test
