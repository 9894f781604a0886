// The point of a joint whose rotation is held, too. Its impulse F turns the bodies, and the lock or
// swing would have to take that back, a pass later, and open the point by it. So the moment with
// which the rotation answers belongs to the point: M = -S+ D' F, as in held_row.hpp. The rotation
// is solved before the point, which then does not change it: one joint is solved exactly. The same
// for lines made chains of sliders diverge.
#pragma once

#include "kernels/joint/answers.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Rows of the moment on B by the force on it, opposite on A.
template <class S>
struct alignas(64) Reaction {
  Real row[S::kAng][S::kDim][kLanes];
};
template <class S>
MW_INLINE typename S::Ang moment_of(const Reaction<S>& by, typename S::Vec p) {
  const auto row = [&](int k) { return dot(load_as<typename S::Vec>(by.row[k][0]), p); };
  if constexpr (S::kDim == 2) {
    return row(0);
  } else {
    return Vec3{row(0), row(1), row(2)};
  }
}

// Whether it has one. In trees all parts are solved together, and targets hold no rotation.
MW_INLINE bool holds_rotation(const JointPart& part) {
  return part.turn_hold != TurnHold::free && part.kind == PartKind::point && !part.direct &&
         !part.spring;
}

// The inverse mass of the point while the rotation is held, and what holds it. `axis`: about which
// a swing leaves the bodies free.
MW_INLINE Sym2 hold_point(const JointPart&, const PartBodies<Planar>& s, Vec2 arm_a, Vec2 arm_b,
                          Float, Reaction<Planar>& by) {
  const Float a = inertia_of(s.a), b = inertia_of(s.b);
  const Float sum = inverse_or_zero(a + b), both = a * b * sum;
  const Vec2 turned = cross(Float(Real(1)), fma(arm_b, b, arm_a * a)),
             apart = cross(Float(Real(1)), arm_b - arm_a);
  const Float mass = Float::load(s.a.inv_mass) + Float::load(s.b.inv_mass);
  store(by.row[0][0], turned * -sum);
  return {fma(apart.x * apart.x, both, mass), apart.x * apart.y * both,
          fma(apart.y * apart.y, both, mass)};
}
MW_INLINE Sym3 hold_point(const JointPart& part, const PartBodies<Tensor>& s, Vec3 arm_a,
                          Vec3 arm_b, Vec3 axis, Reaction<Tensor>& by) {
  const SpatialAnswers of = answers_of(s, arm_a, arm_b);
  const Sym3 inverse_turn =
      part.turn_hold == TurnHold::swing ? inverse_across(of.turn, axis) : inverse(of.turn);
  const Mat3 columns = transposed(of.cross);  // D'
  const Sym3 held = reduced(of.point, columns, inverse_turn);
  // No direction answers less than the masses alone.
  const Float mass = Float::load(s.a.inv_mass) + Float::load(s.b.inv_mass);
  const Mask sound = mass * of.rounding * Float(Real(10)) < mass;
  const Vec3 zero = zero_of<Vec3>();
  const Mat3 rows = transposed(Mat3{-mul(inverse_turn, columns.x), -mul(inverse_turn, columns.y),
                                    -mul(inverse_turn, columns.z)});
  store(by.row[0][0], select(sound, rows.x, zero)),
      store(by.row[1][0], select(sound, rows.y, zero));
  store(by.row[2][0], select(sound, rows.z, zero));
  return select(sound, held, of.point);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
