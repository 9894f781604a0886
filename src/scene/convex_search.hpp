// How two convex parts lie to each other by search, for those whose features cannot be listed.
#pragma once

#include "src/scene/convex.hpp"

namespace manyworlds {

// Neither of the two is a half space.
Separation search_separation(const Convex& a, const Convex& b);

}  // namespace manyworlds
