// What drives and limits do along a coordinate of an edge. They stand in its pivot, so that they
// are as implicit as the joint itself: an impulse p along the rate q of the child against the
// parent, where v = q, or -q where the child is A, has been v0 before the solve.
//
//   spring of a drive   p = k (share target speed - bias_rate C - v),  1 / k = rho K + gamma
//   motor               the same with v = target speed and a k that is hard against the pivot
//   limit               p = k (bound - v) of one sign, hard or as such a spring
//
// (RowSoftness). p = k (w - v0) - k (v - v0): of v itself float would have no digits left. Which
// limits act, and which drives are at their largest impulse, is the active set: guessed by the last
// solve, corrected by this one. Impulses are those of the substep so far.
#pragma once

#include "kernels/direct/edges.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Times the pivot. A limit outdoes a motor that drives into it.
inline constexpr Real kHardMotor = Real(1e3), kHardLimit = Real(1e6);

template <class S, bool kLinear>
class Bound {
 public:
  // closes: limits are closed, too. `first`: the substep has no impulses yet.
  MW_INLINE Bound(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
                  Row<S, kLinear>& s, EdgeDof<S>& dof, bool reversed, bool closes, bool first)
      : part_(part), c_(constants), s_(s), dof_(dof), closes_(closes), first_(first) {
    sign_ = reversed ? Real(-1) : Real(1);
    began_ = Float::load(dof.began) * sign_;
    const Float value = Float::load(s.value);
    if (first) value.store(s.driven);
    inv_h_ = t.inv_h;
    if (part.drive) {
      const DriveTarget target = target_of(g, part, constants);
      wanted_ = target.speed * Float(constants.speed_share);
      if (part.springy) {
        const Float error = Float::load(s.driven) - target.position;
        wanted_ = fnma(error, Float(constants.drive_soft.bias_rate), wanted_);
      }
    }
    if (part.low) low_ = bound(value - Float(constants.low));
    if (part.high) high_ = bound(Float(constants.high) - value);
  }

  // The active set to begin a step with: what acted at the end of the last one.
  MW_INLINE void guess() const {
    const Float zero(Real(0));
    dof_.above = dof_.below = 0;
    dof_.low = bits(zero < Float::load(s_.impulse[1]));
    dof_.high = bits(zero < Float::load(s_.impulse[2]));
  }

  // Adds to the pivot, and to the load.
  MW_INLINE void add(Float pivot, Float& stiffness, Float& push) const {
    const Float zero(Real(0));
    if (part_.drive) {
      const Mask above = mask_from_bits(dof_.above), below = mask_from_bits(dof_.below);
      const Float k = drive_stiffness(pivot), most = c_.max_impulse, so_far = before(0);
      Float p = k * (wanted_ - began_) - (part_.springy ? so_far : zero);
      p = select(above, most - so_far, select(below, zero - most - so_far, p));
      stiffness = stiffness + select(above | below, zero, k), push = fma(p, sign_, push);
    }
    const auto limit = [&](std::uint32_t active, Float least, Float speed, int which) {
      const Mask acts = mask_from_bits(active);
      const Float k = limit_stiffness(pivot);
      const Float p = k * (least - speed) - (part_.soft_limit ? before(which) : zero);
      stiffness = stiffness + select(acts, k, zero);
      return select(acts, p, zero - before(which));
    };
    if (part_.low) push = fma(limit(dof_.low, low_, began_, 1), sign_, push);
    if (part_.high) push = fnma(limit(dof_.high, high_, zero - began_, 2), sign_, push);
  }

  // Corrects the active set by what came of it; returns the lanes in which it changes.
  MW_INLINE std::uint32_t correct() const {
    const Impulses p = impulses();
    const Float zero(Real(0)), change = change_of_speed(), v = began_ + change;
    const std::uint32_t old[4] = {dof_.low, dof_.high, dof_.above, dof_.below};
    if (part_.low) {
      const Mask acts = mask_from_bits(dof_.low);
      dof_.low = bits((acts & (zero < p.low)) | ((v < low_) & !acts));
    }
    if (part_.high) {
      const Mask acts = mask_from_bits(dof_.high);
      dof_.high = bits((acts & (zero < p.high)) | ((zero - v < high_) & !acts));
    }
    if (part_.drive) {
      const Float free = unbounded_drive(change), most = c_.max_impulse;
      dof_.above = bits(most < free), dof_.below = bits(free < zero - most);
    }
    return (dof_.low ^ old[0]) | (dof_.high ^ old[1]) | (dof_.above ^ old[2]) |
           (dof_.below ^ old[3]);
  }

  // Keeps the impulses of the substep.
  MW_INLINE void keep() const {
    const Impulses p = impulses();
    p.drive.store(s_.impulse[0]), p.low.store(s_.impulse[1]), p.high.store(s_.impulse[2]);
  }

 private:
  struct Impulses {
    Float drive, low, high;
  };
  MW_INLINE Float before(int which) const {
    return first_ ? Float(Real(0)) : Float::load(s_.impulse[which]);
  }
  MW_INLINE Float change_of_speed() const { return Float::load(dof_.change) * sign_; }
  MW_INLINE Float one_over(const kernels::RowSoftness<LaneNumber>& soft) const {
    return inverse_or_zero(fma(Float::load(s_.k), Float(soft.rho), soft.gamma));
  }
  MW_INLINE Float drive_stiffness(Float pivot) const {
    return part_.springy ? one_over(c_.drive_soft) : pivot * Float(kHardMotor);
  }
  MW_INLINE Float limit_stiffness(Float pivot) const {
    return part_.soft_limit ? one_over(c_.limit_soft) : pivot * Float(kHardLimit);
  }
  // The least speed towards the inside, by the distance to the limit.
  MW_INLINE Float bound(Float gap) const {
    const Float zero(Real(0)), ahead = zero - gap * inv_h_;
    if (!closes_ && !part_.soft_limit) return min(ahead, zero);
    return select(zero < gap, ahead, zero - gap * Float(c_.limit_soft.bias_rate));
  }
  // Of the substep, if nothing bounded it.
  MW_INLINE Float unbounded_drive(Float change) const {
    const Float k = drive_stiffness(Float::load(dof_.pivot)), zero(Real(0));
    return k * ((wanted_ - began_) - change) + (part_.springy ? zero : before(0));
  }
  // Of the substep, by the active set.
  MW_INLINE Impulses impulses() const {
    const Float zero(Real(0)), change = change_of_speed();
    Impulses out{before(0), zero, zero};
    if (part_.drive) {
      const Float most = c_.max_impulse;
      out.drive = select(mask_from_bits(dof_.above), most,
                         select(mask_from_bits(dof_.below), zero - most, unbounded_drive(change)));
    }
    const auto limit = [&](std::uint32_t active, Float least, Float speed, Float faster,
                           int which) {
      const Float k = limit_stiffness(Float::load(dof_.pivot));
      const Float p = k * ((least - speed) - faster) + (part_.soft_limit ? zero : before(which));
      return select(mask_from_bits(active), p, zero);
    };
    if (part_.low) out.low = limit(dof_.low, low_, began_, change, 1);
    if (part_.high) out.high = limit(dof_.high, high_, zero - began_, zero - change, 2);
    return out;
  }

  const JointPart& part_;
  const Joint& c_;
  Row<S, kLinear>& s_;
  EdgeDof<S>& dof_;
  bool closes_, first_;
  Float sign_ = Real(1), inv_h_ = Real(0), began_ = Real(0);
  Float wanted_ = Real(0);                // speed of a drive
  Float low_ = Real(0), high_ = Real(0);  // bounds of limits
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
