// A scene with everything that joints can do, for tests of bits.
#pragma once

#include "tests/support/joints.hpp"

namespace manyworlds::test {

// Every type of joint, over a ground that some of the bodies fall on.
Scene contraption(Space space);

// Trees of joints that are solved at once, on the world, on a kinematic body and on nothing, over a
// ground that some of the bodies fall on, beside a rope that is swept over.
Scene joint_trees(Space space);

}  // namespace manyworlds::test
