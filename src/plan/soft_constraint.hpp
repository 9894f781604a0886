// A spring and damper along a row, by implicit Euler with steps of h (Catto 2011).
#pragma once

namespace manyworlds {

struct SoftConstraint {
  double rate;  // 1/s: speed that is asked for, per m of what is to be removed
  double gain;  // how much of that it insists on: infinite is hard
};

// Of a frequency > 0, Hz.
inline SoftConstraint soft_constraint(double frequency, double damping_ratio, double h) {
  const double omega = 2 * 3.14159265358979323846 * frequency;
  const double a1 = 2 * damping_ratio + h * omega;
  return {omega / a1, h * omega * a1};
}

}  // namespace manyworlds
