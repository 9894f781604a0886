// Energy that joints hold while what they join has come apart, for the audit of energy. A soft row
// of effective mass m that is C off is a spring:
//   E = k C^2 / 2,  k = m bias_rate / (h rho)
// A hard one (rho = 0) closes at bias_rate C whatever it bears: E = m (bias_rate C)^2 / 2 + |F C|.
// One that closes gradually holds none: what it gives is counted (drive_work.hpp).
#pragma once

#include "kernels/joint/drive_work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// C . K^-1 C and |impulse| |C| of the rows of a part.
struct Gap {
  Float form, load;
};
template <class V, class W>
MW_INLINE Gap gap_of(V error, V by_mass, W impulse) {
  return {dot(error, by_mass), length_of(error) * length_of(impulse)};
}
template <class S>
MW_INLINE Gap gap_of(const JointPart& part, const Joint& constants, const Row<S>& s) {
  const Float zero(Real(0)), value = Float::load(s.value), mass = inverse_or_zero(Float::load(s.k));
  Float error = zero;
  if (part.equality) error = value - Float(constants.rest);
  if (!part.soft_limit) {
    if (part.low) error = error + max(Float(constants.low) - value, zero);
    if (part.high) error = error + max(value - Float(constants.high), zero);
  }
  Float impulse = Float::load(s.impulse[1]) + Float::load(s.impulse[2]);
  if (part.equality) impulse = impulse + abs(Float::load(s.impulse[0]));
  return {error * error * mass, abs(error) * impulse};
}
template <class S>
MW_INLINE Gap gap_of(const JointPart& part, const Joint&, const PointRows<S>& s) {
  using Vec = typename S::Vec;
  if (part.spring || part.gradual) return {Float(Real(0)), Float(Real(0))};
  const Vec gap = load_as<Vec>(s.gap[0]);
  const auto mass = load_as<typename PointMass<S>::Type>(s.mass[0]);
  return gap_of(gap, mul(mass, gap), load_as<Vec>(s.impulse[0]));
}
template <class S>
MW_INLINE Gap gap_of(const JointPart& part, const Joint&, const LineRows<S>& s) {
  if (part.gradual) return {Float(Real(0)), Float(Real(0))};
  const auto impulse = load_as<typename S::Vec>(s.impulse[0]);
  if constexpr (S::kDim == 2) {
    const Float error = Float::load(s.error[0]);
    return gap_of(error, error * Float::load(s.mass[0]), impulse);
  } else {
    const auto error = load_as<Vec2>(s.error[0]);
    return gap_of(error, mul(load_as<Sym2>(s.mass[0]), error), impulse);
  }
}
template <class S>
MW_INLINE Gap gap_of(const JointPart&, const Joint&, const LockRows<S>& s) {
  using Ang = typename S::Ang;
  const auto error = load_as<Ang>(s.error[0]);
  const auto mass = load_as<typename S::Inertia>(s.mass[0]);
  return gap_of(error, apply(mass, error), load_as<Ang>(s.impulse[0]));
}
template <class S>
MW_INLINE Gap gap_of(const JointPart&, const Joint&, const SwingRows<S>& s) {
  const auto error = load_as<Vec2>(s.error[0]);
  return gap_of(error, mul(load_as<Sym2>(s.mass[0]), error), load_as<Vec3>(s.impulse[0]));
}

MW_INLINE Float energy_of(const Constants& t, const kernels::RowSoftness<LaneNumber>& soft,
                          const Gap& gap) {
  const Float zero(Real(0)), half(Real(0.5)), rate = soft.bias_rate, rho = soft.rho;
  const Float spring = half * gap.form * (rate * Float(t.inv_h)) / select(zero < rho, rho, rate);
  const Float hard = fma(half * rate * rate, gap.form, gap.load * Float(t.inv_h));
  return select(zero < rho, spring, hard);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
