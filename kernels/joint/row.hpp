// A single row of a joint along a coordinate x with speed v = J (velocities): held at a value,
// driven, limited, or some of these. Its Jacobian is [-linear_a, -angular_a, linear_b, angular_b]
// (no linear part for rows about an axis), K = J M^-1 J^T.
//   held     C = x - rest, soft in the bias pass
//   driven   force = k (target - x) + c (target speed - v), implicit; |impulse| <= max
//   limited  C = x - low or high - x, lambda >= 0; speculative while C > 0, else soft
#pragma once

#include "kernels/joint/line.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kLinear>
struct alignas(64) Row : AnchoredRows<S> {
  // At the start of the step.
  Real start_axis[3][kLanes], start_axis_b[3][kLanes];
  Real start_rope_a[S::kDim][kLanes], start_rope_b[S::kDim][kLanes];  // of a pulley
  Real start_value[kLanes];
  // Of the substep.
  Real linear_a[S::kDim][kLanes], linear_b[S::kDim][kLanes];
  Real angular_a[S::kAng][kLanes], angular_b[S::kAng][kLanes];
  Real value[kLanes];
  Real driven[kLanes];  // the value of the bias pass
  Real k[kLanes];
};

template <class S, bool kLinear, class Velocities>
MW_INLINE Float speed_of(const Row<S, kLinear>& s, const Velocities& v) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  Float x = dot(load_as<Ang>(s.angular_b[0]), v.b.w) - dot(load_as<Ang>(s.angular_a[0]), v.a.w);
  if constexpr (kLinear) {
    x = x + (dot(load_as<Vec>(s.linear_b[0]), v.b.v) - dot(load_as<Vec>(s.linear_a[0]), v.a.v));
  }
  return x;
}
template <class S, bool kLinear, bool kDense>
MW_INLINE void apply_row(const Row<S, kLinear>& s, Float p, PartVelocities<S, kDense>& v) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const Ang a = load_as<Ang>(s.angular_a[0]) * p, b = load_as<Ang>(s.angular_b[0]) * p;
  if constexpr (kLinear) {
    add_impulse(s.b, load_as<Vec>(s.linear_b[0]), p, b, v.b);
    take_impulse(s.a, load_as<Vec>(s.linear_a[0]), p, a, v.a);
  } else {
    add_moment(s.b, b, v.b);
    take_moment(s.a, a, v.a);
  }
}
template <class S, bool kLinear>
MW_INLINE void weigh_row(Row<S, kLinear>& s) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const Ang a = load_as<Ang>(s.angular_a[0]), b = load_as<Ang>(s.angular_b[0]);
  Float k = dot(a, apply(inertia_of(s.a), a)) + dot(b, apply(inertia_of(s.b), b));
  if constexpr (kLinear) {
    const Vec linear_a = load_as<Vec>(s.linear_a[0]), linear_b = load_as<Vec>(s.linear_b[0]);
    k = k + fma(dot(linear_a, linear_a), Float::load(s.a.inv_mass),
                dot(linear_b, linear_b) * Float::load(s.b.inv_mass));
  }
  k.store(s.k);
}

// lambda' - lambda of a soft row that is to have a speed of 0, before any clamp.
MW_INLINE Float soften_row(const kernels::RowSoftness<LaneNumber>& soft, Float k, Float speed,
                           Float before) {
  const Float softer = fma(k, soft.rho, k) + Float(soft.gamma);
  return -(fma(softer - k, before, speed) * inverse_or_zero(softer));
}
// The same where the row is `error` off.
MW_INLINE Float soften_row(const kernels::RowSoftness<LaneNumber>& soft, Float k, Float speed,
                           Float error, Float before) {
  return soften_row(soft, k, fma(error, soft.bias_rate, speed), before);
}

// What a drive is to reach, by its controls where it has some.
struct DriveTarget {
  Float position, speed;
};
MW_INLINE DriveTarget target_of(const Group& g, const JointPart& part, const Joint& constants) {
  DriveTarget out{constants.target_position, constants.target_speed};
  if (part.position_control >= 0) {
    out.position = Float::load(g.control + part.position_control * kLanes);
  }
  if (part.speed_control >= 0) out.speed = Float::load(g.control + part.speed_control * kLanes);
  return out;
}

// The change of a limit's impulse; `gap` >= 0 while the coordinate is within it.
template <Pass kPass>
MW_INLINE Float solve_limit(const Constants& t, const Joint& constants, Float k, Float speed,
                            Float gap, Real* stored) {
  const Float zero(Real(0)), before = Float::load(stored);
  const Float ahead = fma(max(gap, zero), Float(t.inv_h), speed);
  const Float hard = -(ahead * inverse_or_zero(k));
  Float change = hard;
  if (kPass == Pass::bias) {
    change = select(zero < gap, hard, soften_row(constants.limit_soft, k, speed, gap, before));
  }
  const Float after = max(before + change, zero);
  after.store(stored);
  return after - before;
}

template <class S, bool kLinear, bool kDense, Pass kPass>
MW_INLINE void solve_row(const Constants& t, const Group& g, const JointPart& part,
                         const Joint& constants, Row<S, kLinear>& s, PartVelocities<S, kDense>& v) {
  if constexpr (kPass == Pass::warm_start) {
    const Float low = Float::load(s.impulse[1]), high = Float::load(s.impulse[2]);
    apply_row<S, kLinear, kDense>(s, Float::load(s.impulse[0]) + (low - high), v);
    return;
  }
  const Float k = Float::load(s.k), value = Float::load(s.value);
  if constexpr (kPass == Pass::bias) value.store(s.driven);
  if (part.equality || part.drive) {
    const Float before = Float::load(s.impulse[0]), speed = speed_of(s, v);
    Float after;
    if (part.drive) {  // its equation is the same in both passes
      const DriveTarget target = target_of(g, part, constants);
      const Float most = constants.max_impulse;
      const Float lag = fnma(target.speed, constants.speed_share, speed);
      const Float error = Float::load(s.driven) - target.position;
      after = before + soften_row(constants.drive_soft, k, lag, error, before);
      after = clamp(after, -most, most);
    } else if (kPass == Pass::bias) {
      const Float pull =
          pull_of(value - Float(constants.rest), constants.soft.bias_rate, constants.pull);
      after = before + soften_row(constants.soft, k, speed + pull, before);
    } else {
      after = fnma(speed, inverse_or_zero(k), before);
    }
    after.store(s.impulse[0]);
    apply_row<S, kLinear, kDense>(s, after - before, v);
  }
  if (part.low) {
    const Float gap = value - Float(constants.low);
    const Float speed = speed_of(s, v);
    apply_row<S, kLinear, kDense>(s, solve_limit<kPass>(t, constants, k, speed, gap, s.impulse[1]),
                                  v);
  }
  if (part.high) {
    const Float gap = Float(constants.high) - value;
    const Float speed = -speed_of(s, v);
    apply_row<S, kLinear, kDense>(s, -solve_limit<kPass>(t, constants, k, speed, gap, s.impulse[2]),
                                  v);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
