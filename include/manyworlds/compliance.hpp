// Softness of a constraint of Solver::newton: MuJoCo's solref and solimp (MuJoCo, "Modeling",
// solver parameters). A constraint with violation r has the reference acceleration
//   -damping v - stiffness d(r) r,
// and yields to the fraction 1 - d(r) of the forces against it. The impedance d increases from
// min_impedance at 0 to max_impedance at `width`, along a power curve with its inflection at
// `midpoint`.
#pragma once

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

struct Compliance {
  // s and 1. If both are negative: -stiffness, 1/s^2, and -damping, 1/s. Time constants below two
  // steps are raised to two steps.
  double time_constant = 0.02, damping_ratio = 1;
  double min_impedance = 0.9, max_impedance = 0.95;  // in (0, 1)
  double width = 0.001;                              // m or rad
  double midpoint = 0.5;                             // fraction of the width, in (0, 1)
  double power = 2;                                  // >= 1
  bool operator==(const Compliance&) const = default;
};

}  // namespace manyworlds
