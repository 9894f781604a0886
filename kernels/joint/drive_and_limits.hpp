// What drives and limits a coordinate x of speed v, as one system:
//   drive  force = k (target - x) + c (target speed - v), implicit; |impulse| <= max
//   limit  C = x - low or high - x, impulse >= 0; speculative while C > 0, else soft in the bias
//          pass; with a spring as implicit as a drive, and the same in both passes
// One after the other, a motor would push through its own limit. A rigid limit against a drive is
// hard, and a rigid motor yields to it, as in trees.
#pragma once

#include "kernels/joint/held_row.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

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

// Impulses of a substep so far.
struct RowImpulses {
  Float drive, low, high;
  MW_INLINE Float sum() const { return drive + (low - high); }
};

inline constexpr Real kFirmMotor = Real(1e-3);  // of K: compliance of a rigid motor at a limit

// What free rotation adds in a substep to the mean speed of a coordinate with hard limits.
template <class S>
MW_INLINE Float curving(const Work& w, const JointPart& part, const Row<S>& s) {
  if constexpr (S::kDim == 3) {
    if ((!part.low && !part.high) || part.soft_limit) return Real(0);
    const Vec3 a = load_vec3(half_change(w, s.body_a)), b = load_vec3(half_change(w, s.body_b));
    return dot(load_vec3(s.angular_b[0]), b) - dot(load_vec3(s.angular_a[0]), a);
  } else {
    return Real(0);
  }
}

// The impulses with which the row ends this pass. `speed`: without any of them.
template <class S, Pass kPass>
MW_INLINE RowImpulses drive_and_limit(const Constants& t, const Group& g, const JointPart& part,
                                      const Joint& constants, const Row<S>& s, Float speed,
                                      Float curved) {
  const Float zero(Real(0)), k = Float::load(s.k), most = constants.max_impulse;
  const Float k_soft = k_of_springs(part, s);
  RowImpulses out{zero, zero, zero};
  // v + lag + give p = 0 of a drive
  Float give = zero, lag = zero;
  if (part.drive) {
    const DriveTarget target = target_of(g, part, constants);
    const auto& soft = constants.drive_soft;
    give = fma(k_soft, soft.rho, Float(soft.gamma));
    lag = fms(Float::load(s.driven) - target.position, soft.bias_rate,
              target.speed * Float(constants.speed_share));
    out.drive = clamp(-((speed + lag) * inverse_or_zero(k + give)), -most, most);
  }
  const auto stop = [&](Float sign, Float gap, Float& impulse) {
    // sign v + error + soft p = 0 of a limit
    const Mask within = zero < gap;
    Float error = max(gap, zero) * Float(t.inv_h), soft = zero;
    if (kPass == Pass::bias || part.soft_limit) {
      const auto& by = constants.limit_soft;
      error = fma(curved, sign, select(within, error, gap * Float(by.bias_rate)));
      const Float of_spring(by.gamma);
      const bool hard = part.drive && !part.soft_limit;
      const Float weighs = part.soft_limit ? k_soft : k;
      soft = select(within, zero, hard ? of_spring : fma(weighs, by.rho, of_spring));
    }
    const Float reached = fma(k, out.drive, speed) * sign + error;
    const Mask acts = reached < zero;
    if (!any(acts)) return;
    Float drive = out.drive;
    if (part.drive) {
      // Both as if the drive had no bound, then the drive within its bounds.
      const Float firm = max(give, k * Float(kFirmMotor)), sum = k + firm;
      const Float lack = fma(fnma(k, lag, firm * speed), sign, error * sum);
      const Float both = max(-(lack * inverse_or_zero(fma(soft, sum, k * firm))), zero);
      const Float v = (fma(k, both * sign, speed) * firm - k * lag) * inverse_or_zero(sum);
      drive = clamp(-((v + lag) * inverse_or_zero(firm)), -most, most);
    }
    const Float lack = fma(k, drive, speed) * sign + error;
    impulse = select(acts, max(-(lack * inverse_or_zero(k + soft)), zero), zero);
    out.drive = select(acts, drive, out.drive);
  };
  const Float value = Float::load(part.soft_limit ? s.driven : s.value);
  if (part.low) stop(Float(Real(1)), value - Float(constants.low), out.low);
  if (part.high) stop(Float(Real(-1)), Float(constants.high) - value, out.high);
  return out;
}

// As curvature_between, of the distance, which what moves across it by p in the substep stretches.
template <class S, bool kDense>
MW_INLINE Float distance_curvature(const Constants& t, const Work& w, const JointPart& part,
                                   const Joint& constants, const Row<S>& s,
                                   const PartVelocities<S, kDense>& v) {
  using Vec = typename S::Vec;
  if (part.kind != PartKind::distance || !part.curved) return Real(0);
  const auto n = load_as<Vec>(s.linear_b[0]), arm_a = load_as<Vec>(s.start_rope_a[0]),
             arm_b = load_as<Vec>(s.start_rope_b[0]);
  const Vec curved = curvature_between<S>(w, s, arm_a, arm_b);
  // With half of the warm start, as the motion will have on average.
  const auto before = load_sides<S, Free, kDense>(w.warmed, s);
  const Vec both = (point_velocity(before.b, arm_b) - point_velocity(before.a, arm_a)) +
                   anchor_speed<S, kDense>(v, arm_a, arm_b);
  const Vec speed = fma(both, Float(Real(0.5)), curved);
  const Vec all = fnma(n, dot(n, speed), speed) * Float(t.h),
            across = select(curved_lanes(w, s), all, zero_of<Vec>());
  const Float rest = constants.rest, square = rest * rest;
  const Float left = max(square - dot(across, across), square * Float(Real(0.5)));
  return fma(rest - sqrt(left), Float(t.inv_h), dot(n, curved));
}

template <class S, bool kDense, Pass kPass>
MW_INLINE void solve_placed(const Constants& t, const Group& g, const Work& w,
                            const JointPart& part, const Joint& constants, Row<S>& s,
                            PartVelocities<S, kDense>& v) {
  const RowImpulses before{Float::load(s.impulse[0]), Float::load(s.impulse[1]),
                           Float::load(s.impulse[2])};
  if constexpr (kPass == Pass::warm_start) {
    apply_row<S, kDense>(s, before.sum(), v);
    return;
  }
  const Float k = Float::load(s.k), value = Float::load(s.value), speed = speed_of(s, v);
  if constexpr (kPass == Pass::bias) value.store(s.driven);
  if (part.equality) {
    Float after = fnma(speed, inverse_or_zero(k), before.drive);
    if (kPass == Pass::bias) {
      const Float pull =
          pull_of(value - Float(constants.rest), constants.soft.bias_rate, constants.pull);
      const Float firm = Float(constants.soft.rho) + Float(Real(1));
      const Float curved =
          fma(distance_curvature<S>(t, w, part, constants, s, v), firm, speed + pull);
      after = before.drive + soften_row(constants.soft, k, curved, before.drive);
    }
    after.store(s.impulse[0]);
    apply_row<S, kDense>(s, after - before.drive, v);
    return;
  }
  const Float curved = kPass == Pass::bias ? curving(w, part, s) : Float(Real(0));
  const RowImpulses after =
      drive_and_limit<S, kPass>(t, g, part, constants, s, fnma(k, before.sum(), speed), curved);
  after.drive.store(s.impulse[0]), after.low.store(s.impulse[1]), after.high.store(s.impulse[2]);
  apply_row<S, kDense>(s, after.sum() - before.sum(), v);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
