// Drives that sweeps over joints do not follow. Used inside src/plan only.
#pragma once

#include <string>

#include "src/plan/joint_trees.hpp"

namespace manyworlds {

// Why the joints of a tree are to be solved at once, or "": rows of one joint are exact for its two
// bodies, however stiff its drive. What drives of a chain do to one another is swept over, which
// converges while none is stiffer in a substep than the inertia that it moves.
std::string need_of_drives(const Scene& scene, const SceneTrees& trees);

}  // namespace manyworlds
