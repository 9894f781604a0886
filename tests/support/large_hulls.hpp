// Hulls of many corners.
#pragma once

#include "manyworlds/shape.hpp"
#include "tests/support/random.hpp"

namespace manyworlds::test {

// Kinds: an ellipsoid, a needle, a disc, a box with round edges, a prism whose two caps have half
// of all corners each, and a dome whose corners crowd at its top.
inline constexpr int kLargeHulls = 6;
// About `corners` of them, within 0.1 to 0.7 m of the origin.
Hull large_hull(int kind, int corners, Random& random);

}  // namespace manyworlds::test
