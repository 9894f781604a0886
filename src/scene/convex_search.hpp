// How two convex parts lie to each other by search, for those whose features cannot be listed.
#pragma once

#include "src/scene/convex.hpp"

namespace manyworlds {

// Whether all pairs of edges can be looked at in good time.
inline bool few_crossings(const Convex& a, const Convex& b) {
  return a.directions.size() * b.directions.size() <= 40000;
}

// Neither of the two is a half space.
Separation search_separation(const Convex& a, const Convex& b);

}  // namespace manyworlds
