// What drives and limits do along a coordinate of an edge. They stand in its pivot, so that they
// are as implicit as the joint itself: an impulse of push - stiffness q along the rate q of the
// child against the parent, with v = q, or -q where the child is A.
//   drive, spring  p = -(v - share target speed + bias_rate C) / c,  c = rho K + gamma
//   (RowSoftness) motor          v = target speed, hard limit          v >= v_low or v <= v_high,
//   hard or as such a spring, p of one sign
// Which limits act, and which drives are at their largest impulse, is a set that is guessed by the
// last solve and corrected by this one. Impulses are those of the substep so far.
#pragma once

#include "kernels/direct/edges.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kHardRow = Real(1e4);  // times the pivot

template <class S, bool kLinear>
class Bound {
 public:
  // kCloses: limits are closed, too. `first`: the substep has no impulses yet.
  MW_INLINE Bound(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
                  Row<S, kLinear>& s, EdgeDof<S>& dof, bool reversed, bool closes, bool first)
      : part_(part), c_(constants), s_(s), dof_(dof), closes_(closes), first_(first) {
    sign_ = reversed ? Real(-1) : Real(1);
    const Float value = Float::load(s.value);
    if (first) value.store(s.driven);
    inv_h_ = t.inv_h;
    if (part.drive) {
      const DriveTarget target = target_of(g, part, constants);
      speed_ = target.speed * Float(constants.speed_share);
      error_ = Float::load(s.driven) - target.position;
    }
    if (part.low) gap_low_ = value - Float(constants.low);
    if (part.high) gap_high_ = Float(constants.high) - value;
  }

  // Sets to begin a step with: what acted at the end of the last one.
  MW_INLINE void guess() const {
    const Float zero(Real(0));
    dof_.above = dof_.below = 0;
    dof_.low = bits(zero < Float::load(s_.impulse[1]));
    dof_.high = bits(zero < Float::load(s_.impulse[2]));
  }

  // Adds to the pivot, and to the load, by the sets.
  MW_INLINE void add(Float pivot, Float& stiffness, Float& push) const {
    const Float zero(Real(0)), hard = pivot * Float(kHardRow);
    if (part_.drive) {
      const Mask above = mask_from_bits(dof_.above), below = mask_from_bits(dof_.below);
      const Float most = c_.max_impulse, so_far = before(0);
      const Float k = drive_stiffness(hard);
      Float p = drive_push(k) - (is_motor() ? zero : so_far);
      p = select(above, most - so_far, select(below, zero - most - so_far, p));
      stiffness = stiffness + select(above | below, zero, k), push = fma(p, sign_, push);
    }
    if (part_.low) {
      const Mask acts = mask_from_bits(dof_.low);
      const Float k = limit_stiffness(hard);
      const Float p = limit_push(k, gap_low_) - (part_.soft_limit ? before(1) : zero);
      stiffness = stiffness + select(acts, k, zero);
      push = fma(select(acts, p, zero - before(1)), sign_, push);
    }
    if (part_.high) {
      const Mask acts = mask_from_bits(dof_.high);
      const Float k = limit_stiffness(hard);
      const Float p = limit_push(k, gap_high_) - (part_.soft_limit ? before(2) : zero);
      stiffness = stiffness + select(acts, k, zero);
      push = fnma(select(acts, p, zero - before(2)), sign_, push);
    }
  }

  // Corrects the sets by the rate that came of them; returns the lanes in which they change.
  MW_INLINE std::uint32_t correct(Float rate) const {
    const Totals p = totals(rate);
    const Float zero(Real(0)), v = rate * sign_;
    const std::uint32_t old[4] = {dof_.low, dof_.high, dof_.above, dof_.below};
    if (part_.low) {
      const Mask acts = mask_from_bits(dof_.low);
      dof_.low = bits((acts & (zero < p.low)) | ((v < bound(gap_low_)) & !acts));
    }
    if (part_.high) {
      const Mask acts = mask_from_bits(dof_.high);
      dof_.high = bits((acts & (zero < p.high)) | ((zero - v < bound(gap_high_)) & !acts));
    }
    if (part_.drive) {
      // What the drive would do if nothing bounded it.
      const Float hard = Float::load(dof_.pivot) * Float(kHardRow), most = c_.max_impulse;
      const Float k = drive_stiffness(hard);
      const Float free = drive_push(k) - k * v + (is_motor() ? before(0) : zero);
      dof_.above = bits(most < free), dof_.below = bits(free < zero - most);
    }
    return (dof_.low ^ old[0]) | (dof_.high ^ old[1]) | (dof_.above ^ old[2]) |
           (dof_.below ^ old[3]);
  }

  // Keeps the impulses of the substep.
  MW_INLINE void keep(Float rate) const {
    const Totals p = totals(rate);
    p.drive.store(s_.impulse[0]), p.low.store(s_.impulse[1]), p.high.store(s_.impulse[2]);
  }

 private:
  struct Totals {
    Float drive, low, high;
  };
  MW_INLINE Float before(int which) const {
    return first_ ? Float(Real(0)) : Float::load(s_.impulse[which]);
  }
  MW_INLINE bool is_motor() const { return !part_.springy; }
  MW_INLINE Float drive_stiffness(Float hard) const {
    return is_motor() ? hard : one_over(c_.drive_soft);
  }
  MW_INLINE Float drive_push(Float stiffness) const {
    if (is_motor()) return stiffness * speed_;
    return stiffness * fnma(error_, Float(c_.drive_soft.bias_rate), speed_);
  }
  MW_INLINE Float limit_stiffness(Float hard) const {
    return part_.soft_limit ? one_over(c_.limit_soft) : hard;
  }
  // Along the way back from the limit.
  MW_INLINE Float limit_push(Float stiffness, Float gap) const { return stiffness * bound(gap); }
  // The least speed towards the inside.
  MW_INLINE Float bound(Float gap) const {
    const Float zero(Real(0)), ahead = zero - gap * inv_h_;
    if (part_.soft_limit) return min(zero, ahead) - min(gap, zero) * Float(c_.limit_soft.bias_rate);
    if (!closes_) return min(ahead, zero);
    return select(zero < gap, ahead, zero - gap * Float(c_.limit_soft.bias_rate));
  }
  MW_INLINE Float one_over(const kernels::RowSoftness<LaneNumber>& soft) const {
    return inverse_or_zero(fma(Float::load(s_.k), Float(soft.rho), soft.gamma));
  }
  // Of the substep with this rate, by the sets.
  MW_INLINE Totals totals(Float rate) const {
    const Float zero(Real(0)), v = rate * sign_;
    const Float hard = Float::load(dof_.pivot) * Float(kHardRow);
    Totals out{before(0), zero, zero};
    if (part_.drive) {
      const Float k = drive_stiffness(hard), most = c_.max_impulse;
      out.drive = drive_push(k) - k * v + (is_motor() ? before(0) : zero);
      out.drive = select(mask_from_bits(dof_.above), most,
                         select(mask_from_bits(dof_.below), zero - most, out.drive));
    }
    const auto limit = [&](std::uint32_t acts, Float gap, Float speed, int which) {
      const Float k = limit_stiffness(hard);
      const Float p = limit_push(k, gap) - k * speed + (part_.soft_limit ? zero : before(which));
      return select(mask_from_bits(acts), p, zero);
    };
    if (part_.low) out.low = limit(dof_.low, gap_low_, v, 1);
    if (part_.high) out.high = limit(dof_.high, gap_high_, zero - v, 2);
    return out;
  }

  const JointPart& part_;
  const Joint& c_;
  Row<S, kLinear>& s_;
  EdgeDof<S>& dof_;
  bool closes_, first_;
  Float sign_ = Real(1), inv_h_ = Real(0);
  Float speed_ = Real(0), error_ = Real(0), gap_low_ = Real(0), gap_high_ = Real(0);
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
