// How soft a constraint of the newton solver is: MuJoCo's solref and solimp, as the kernels want
// them (MuJoCo, "Computation", constraint model).
#pragma once

#include <array>

#include "kernels/data/tree_tables.hpp"

namespace manyworlds {

struct Compliance {
  // Time constant, s, and damping ratio; both negative: -stiffness and -damping.
  std::array<double, 2> reference{0.02, 1};
  // Least and greatest impedance, the width over which it goes from one to the other, m or rad,
  // where in the width half of that is done, and the power of the curve.
  std::array<double, 5> impedance{0.9, 0.95, 0.001, 0.5, 2};
};

// A time constant shorter than 2 dt counts as that, as MuJoCo's flag refsafe has it.
kernels::Compliance<double> compile(const Compliance& compliance, double dt);

}  // namespace manyworlds
