// Compliance as the kernels take it (MuJoCo, "Computation", constraint model).
#pragma once

#include "kernels/data/tree_tables.hpp"
#include "manyworlds/compliance.hpp"

namespace manyworlds {

// A time constant shorter than 2 dt counts as that, as MuJoCo's flag refsafe has it.
kernels::Compliance<double> compile(const Compliance& compliance, double dt);
int power_of(const Compliance& compliance);  // of its impedance, whole

}  // namespace manyworlds
