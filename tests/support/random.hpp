// Random draws of the tests.
#pragma once

#include "tools/base/random.hpp"

namespace manyworlds::test {

using tools::Random;

}  // namespace manyworlds::test
