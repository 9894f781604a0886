// How soft a constraint of Solver::newton is: MuJoCo's solref and solimp (MuJoCo, "Modeling",
// solver parameters). A constraint that is violated by r asks for the acceleration
//   -damping v - stiffness d(r) r,
// and gives way to a share 1 - d(r) of what acts against it. The impedance d goes from
// min_impedance at 0 to max_impedance at `width`, along a power curve with its inflection at
// `midpoint`.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

struct Compliance {
  // s and 1; both negative: -stiffness, 1/s^2, and -damping, 1/s. A time constant counts as no
  // shorter than two steps.
  double time_constant = 0.02, damping_ratio = 1;
  double min_impedance = 0.9, max_impedance = 0.95;  // in (0, 1)
  double width = 0.001;                              // m or rad
  double midpoint = 0.5;                             // share of the width, in (0, 1)
  double power = 2;                                  // >= 1
  bool operator==(const Compliance&) const = default;
};

}  // namespace manyworlds
