// A number within an absolute distance of another.
#pragma once

#include <catch2/catch.hpp>

namespace manyworlds::test {

// Catch's own default lets a relative error of 1.2e-5 pass beside any margin.
inline Approx approx(double expected, double margin) {
  return Approx(expected).epsilon(0).margin(margin);
}

}  // namespace manyworlds::test
