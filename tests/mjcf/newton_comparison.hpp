// A model in Solver::newton beside MuJoCo stepping the same model (tools/compare), in the terms of
// the tests.
#pragma once

#include <algorithm>
#include <cstdio>
#include <string>

#include "tests/support/tables.hpp"
#include "tools/compare/paths.hpp"
#include "tools/compare/states.hpp"

namespace manyworlds::test {

// Both solve until the numbers go no closer to the minimum. Costs fall with the square of what the
// accelerations are off.
inline const compare::Settings kConverged{1e-26, 5};

inline compare::Kernels kernels_of(const Table& table) { return {table.precision, table.isa}; }

inline compare::Pair pair_of(const std::string& xml,
                             const compare::Settings& settings = kConverged) {
  return compare::Pair(MjcfFiles::of_string(xml), settings);
}

// Of the accelerations under constraints, and of all next positions and velocities.
inline compare::Quantity acceleration(const compare::StateComparison& c) {
  return c.at("qacc, constrained");
}
inline compare::Quantity next(const compare::StateComparison& c) {
  compare::Quantity all{"next state"};
  for (const compare::Quantity& q : c.quantities) {
    if (q.name.starts_with("next")) {
      all.differences.insert(all.differences.end(), q.differences.begin(), q.differences.end());
    }
  }
  std::sort(all.differences.begin(), all.differences.end());
  return all;
}

inline std::string to_string(const compare::StateComparison& c) {
  std::string out;
  for (const compare::Quantity& q : c.quantities) {
    char text[200];
    std::snprintf(text, sizeof text, "%s %.2g, median %.2g, in %zu; ", q.name.c_str(), q.most(),
                  q.median(), q.differences.size());
    out += text;
  }
  return out + std::to_string(c.contacts) + " contacts and " + std::to_string(c.rows) +
         " rows, other contacts in " + std::to_string(c.other_contacts) + ", uncertain ones in " +
         std::to_string(c.uncertain) + " of " + std::to_string(c.states);
}

}  // namespace manyworlds::test
