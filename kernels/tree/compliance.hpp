// Impedance, regularisation and reference acceleration of a row (MuJoCo, "Computation").
#pragma once

#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Compliance = kernels::Compliance<LaneNumber>;

MW_INLINE Float whole_power(Float x, int power) {
  Float y = x;
  for (int i = 1; i < power; ++i) y = y * x;
  return y;
}

MW_INLINE Float impedance(const Compliance& c, int power, Float violation) {
  const Float x = min(abs(violation) * Float(c.inverse_width), Real(1));
  const Float rising = Float(c.rising) * whole_power(x, power);
  const Float falling = fnma(Float(c.falling), whole_power(Float(Real(1)) - x, power), Real(1));
  return fma(select(x <= Float(c.middle), rising, falling), Float(c.gain), Float(c.least));
}

// A row before it is solved: 1 / R, and the reference acceleration.
struct SoftRow {
  Float weight, reference;
};
MW_INLINE SoftRow soft_row(const Compliance& c, int power, Float inverse_weight, Float violation,
                           Float speed) {
  const Float d = impedance(c, power, violation);
  const Float r = max((Float(Real(1)) - d) * inverse_weight, Real(1e-15));
  const Float pull = Float(c.stiffness) * d * violation;
  return {d / r, -fma(Float(c.damping), speed, pull)};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
