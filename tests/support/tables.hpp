// Which kernel tables the tests run on.
#pragma once

#include <string>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::test {

struct Table {
  Isa isa;
  Precision precision;
};
std::string name(const Table& table);

// Every kernel table that this build has and this machine runs; those of one instruction set if
// MANYWORLDS_ISA names it, since what is compared between them has then been. Development and
// sanitizer builds leave float64 out; AVX-512 has float32 only.
const std::vector<Table>& all_tables();
bool has_table(const Table& table);
// The instruction set that is taken by default, in every precision that the build has: for tests
// whose cost matters. Bits are equal over instruction sets (bits_test.cpp), so nothing is lost.
std::vector<Table> widest_tables();
Isa widest_of(Precision precision);  // scalar if the build has none of this precision
// The widest table of float64, for tests that only make sense in it: ask has_table() first.
inline Table double_table() { return {widest_of(Precision::f64), Precision::f64}; }

BatchOptions options_of(const Table& table, int worlds = 1, int threads = 1);

// A tolerance for each precision.
inline double pick(const Table& table, double f32, double f64) {
  return table.precision == Precision::f32 ? f32 : f64;
}

}  // namespace manyworlds::test
