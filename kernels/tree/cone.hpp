// An elliptic cone of a contact (MuJoCo, "Computation", elliptic cones): cost of the residuals x =
// (n, t) = J a - reference of its normal and two tangents, with the friction coefficient f, the
// weight D of the normal row and E = D / (1 + mu^2), mu = f / sqrt(impedance ratio), as three
// zones:
//   f |t| <= n            open: 0
//   f |t| <= -mu^2 n      sticking: D/2 (n^2 + |t|^2 f^2 / mu^2)
//   else                  sliding: E/2 (n - f |t|)^2
#pragma once

#include "kernels/tree/kinematics.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// J' D J of a contact in its frame.
struct PointStiffness {
  Float normal, normal_1, normal_2, tangent_1, tangent_2, tangents;
};

// The same as a sum of squares: weights times those of motions along directions.
struct ConeTerms {
  Vec3 along[3];
  Float weight[3];
};

class Cone {
 public:
  MW_INLINE Cone(const TreeContact& c, Real impedance_ratio)
      : c_(c),
        weight_(Float::load(c.weight)),
        friction_(Float::load(c.friction)),
        stick_(weight_ * Float(impedance_ratio)),
        mu2_(friction_ * friction_ * Float(Real(1) / impedance_ratio)),
        slide_(weight_ / (Float(Real(1)) + mu2_)) {}

  // Along the normal and the tangents.
  MW_INLINE Vec3 force() const {
    const Point p = at(load_vec3(c_.residual[0]));
    const Float zero(Real(0)), slide_force = slide_ * p.gap;
    const Float normal = select(p.sticks, weight_ * p.normal, slide_force);
    const Float drag = select(p.sticks, stick_, -(slide_force * friction_) * p.inverse);
    const Mask acts = p.sticks | p.slides;
    return {select(acts, -normal, zero), select(acts, -(drag * p.one), zero),
            select(acts, -(drag * p.two), zero)};
  }

  MW_INLINE PointStiffness stiffness() const {
    const Point p = at(load_vec3(c_.residual[0]));
    const Float zero(Real(0)), one = p.one * p.inverse, two = p.two * p.inverse;
    const Float pull = -(slide_ * friction_);
    const Float round = pull * p.gap * p.inverse;  // of a residual that rotates about the normal
    const Float radial = fma(-pull, friction_, -round);
    const auto of = [&](Float slides, Float sticks) {
      return select(p.sticks, sticks, select(p.slides, slides, zero));
    };
    return {of(slide_, weight_),
            of(pull * one, zero),
            of(pull * two, zero),
            of(fma(radial * one, one, round), stick_),
            of(fma(radial * two, two, round), stick_),
            of(radial * one * two, zero)};
  }

  MW_INLINE ConeTerms terms() const {
    const Point p = at(load_vec3(c_.residual[0]));
    const Float zero(Real(0)), unit(Real(1)), one = p.one * p.inverse, two = p.two * p.inverse;
    const auto of = [&](Float slides, Float sticks) {
      return select(p.sticks, sticks, select(p.slides, slides, zero));
    };
    return {{{unit, of(-(friction_ * one), zero), of(-(friction_ * two), zero)},
             {zero, of(-two, unit), of(one, zero)},
             {zero, zero, unit}},
            {of(slide_, weight_), of(-(slide_ * friction_) * p.gap * p.inverse, stick_),
             of(zero, stick_)}};
  }

  // Adds the derivatives of the cost where the step leads.
  MW_INLINE void add_along(Float step, Float& first, Float& second) const {
    const Vec3 rate = load_vec3(c_.change[0]);
    const Point p = at(fma(rate, step, load_vec3(c_.residual[0])));
    const Float zero(Real(0));
    const Float tangential = fma(p.two, rate.z, p.one * rate.y);  // t . dt
    const Float rate2 = fma(rate.z, rate.z, rate.y * rate.y);
    const Float grows = friction_ * tangential * p.inverse;
    const Float across = tangential * p.inverse;
    const Float bends = friction_ * max(fnma(across, across, rate2), Real(0)) * p.inverse;
    const Float closes = rate.x - grows;
    const Float slope = select(p.sticks, fma(stick_, tangential, weight_ * p.normal * rate.x),
                               slide_ * p.gap * closes);
    const Float curve = select(p.sticks, fma(stick_, rate2, weight_ * rate.x * rate.x),
                               slide_ * fnma(p.gap, bends, closes * closes));
    const Mask acts = p.sticks | p.slides;
    first = first + select(acts, slope, zero), second = second + select(acts, curve, zero);
  }

  // Goes the step but in lanes that are done; returns those in which the cost is another quadratic
  // afterwards, or none.
  MW_INLINE Mask advance(Real* residual, Float step, Mask done) const {
    const Vec3 from = load_vec3(c_.residual[0]);
    const Vec3 to = select(done, from, fma(load_vec3(c_.change[0]), step, from));
    store(residual, to);
    const Point before = at(from), after = at(to);
    const Mask changed =
        (before.sticks & !after.sticks) | (after.sticks & !before.sticks) | after.slides;
    return (changed | before.slides) & !done & (Float(Real(0)) < weight_);
  }

 private:
  struct Point {
    Float normal, one, two;
    Float gap;      // n - f |t|
    Float inverse;  // 1 / |t|, or 0
    Mask sticks, slides;
  };
  MW_INLINE Point at(Vec3 x) const {
    const Float zero(Real(0)), one(Real(1)), square = fma(x.z, x.z, x.y * x.y);
    const Mask moves = zero < square;
    const Float length = sqrt(square), t = friction_ * length;
    const Mask active = x.x < t, sticks = active & (t <= -(mu2_ * x.x));
    return {x.x,
            x.y,
            x.z,
            x.x - t,
            select(moves, one / select(moves, length, one), zero),
            sticks,
            active & !sticks};
  }

  const TreeContact& c_;
  Float weight_, friction_;
  Float stick_, mu2_, slide_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
