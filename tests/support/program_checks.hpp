// How the program refuses: with one line on standard error.
#pragma once

#include <algorithm>
#include <string>

#include <catch2/catch.hpp>

#include "tests/support/program.hpp"

namespace manyworlds::test {

inline void check_one_line(const Outcome& outcome, const std::string& message) {
  INFO(outcome.err);
  CHECK(outcome.code == 2);
  CHECK(contains(outcome.err, message));
  CHECK(outcome.err.rfind("manyworlds: ", 0) == 0);
  CHECK(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
}
inline void check_refused(const Outcome& outcome, const std::string& message) {
  check_one_line(outcome, message);
  CHECK(outcome.out.empty());
}

}  // namespace manyworlds::test
