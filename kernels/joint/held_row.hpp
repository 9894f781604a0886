// Rows of a joint whose other parts hold its bodies together. A drive that turns an arm about a
// hinge moves all of the arm, and the hinge moves its own reaction. A row that knew of the moments
// of inertia alone would push several times as hard as is right, and the hinge would take it back
// one pass later.
//
// So what the other parts do to a unit impulse belongs to the row: a force F at the anchors and a
// moment M, opposite on A, that leave alone what they hold. With S, D, K the relative rotation due
// to a moment, the relative velocity of the anchors due to it, and that due to a force, K+ and S+
// the inverses of K and S over the directions that are held:
//   a rotation about n       F = -K+ D M,   G = S - D' K+ D,   M = n, or where the axes stay
//                            parallel G^-1 n / n' G^-1 n
//   a displacement along x   M = -S+ D' F,  H = K - D S+ D',   F = H^-1 x / x' H^-1 x
// Then the row's Jacobian is that of F and M, and its K = n' G M, or x' H F.
#pragma once

#include "kernels/joint/row.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// What a unit impulse of the row does, and its K.
template <class S>
struct HeldRow {
  typename S::Vec force;
  typename S::Ang moment;
  Float k;
};

// In the plane by sums of what is positive: long arms leave nothing of the differences. With m the
// sum of inverse masses, a and b inverse moments of inertia, and r the arms,
//   det K = m (m + a ra^2 + b rb^2 + a b (ra x rb)^2 / m)
class PlanarPair {
 public:
  MW_INLINE PlanarPair(const Row<Planar>& s, Vec2 arm_a, Vec2 arm_b)
      : a_(inertia_of(s.a)),
        b_(inertia_of(s.b)),
        mass_(Float::load(s.a.inv_mass) + Float::load(s.b.inv_mass)),
        by_mass_(inverse_or_zero(mass_)),
        arm_a_(arm_a),
        arm_b_(arm_b),
        apart_(arm_b - arm_a),
        point_{Float(Real(0)), Float(Real(0)), Float(Real(0))} {
    add_point_mass(s.a, arm_a, point_), add_point_mass(s.b, arm_b, point_);
  }
  // About a point.
  MW_INLINE HeldRow<Planar> turn() const {
    const Float by = inverse_or_zero(determinant());
    const Float k = fma(mass_, a_ + b_, a_ * b_ * dot(apart_, apart_));
    return {adjugate(turned()) * -(by * by_mass_), Float(Real(1)), k * by};
  }
  // About a point that slides along a unit vector.
  MW_INLINE HeldRow<Planar> turn_beside(Vec2 axis) const {
    const Vec2 d{-axis.y, axis.x};
    const Float u = cross(arm_a_, d), w = cross(arm_b_, d), across = u - w;
    const Float by = inverse_or_zero(across_mass(d));
    const Float k = fma(mass_, a_ + b_, a_ * b_ * (across * across));
    return {d * -(fma(b_, w, a_ * u) * by), Float(Real(1)), k * by};
  }
  // Along a unit vector, if the rotation is locked, or free.
  MW_INLINE HeldRow<Planar> slide_locked(Vec2 axis) const {
    const Float sum = inverse_or_zero(a_ + b_), c = a_ * b_ * sum;
    const Vec2 q = cross(Float(Real(1)), apart_);
    const Float along = dot(q, axis), across = cross(q, axis), all = fma(c, dot(q, q), mass_);
    const Float by = inverse_or_zero(fma(c, across * across, mass_));
    const Vec2 force = fnma(q, c * along, axis * all) * by;
    return {force, -(dot(turned(), force) * sum), mass_ * all * by};
  }
  MW_INLINE HeldRow<Planar> slide(Vec2 axis) const {
    const Float by = inverse_or_zero(across_mass({-axis.y, axis.x}));
    return {adjugate(axis) * by, Float(Real(0)), mass_ * determinant() * by};
  }

 private:
  MW_INLINE Float determinant() const {  // over m
    const Float x = cross(arm_a_, arm_b_);
    const Float arms = fma(b_, dot(arm_b_, arm_b_), a_ * dot(arm_a_, arm_a_));
    return fma(a_ * x, b_ * x * by_mass_, mass_ + arms);
  }
  MW_INLINE Vec2 turned() const {  // D
    return cross(Float(Real(1)), fma(arm_b_, b_, arm_a_ * a_));
  }
  MW_INLINE Float across_mass(Vec2 d) const {
    const Float u = cross(arm_a_, d), w = cross(arm_b_, d);
    return fma(b_, w * w, fma(a_, u * u, mass_));
  }
  // K^-1 v, times its determinant.
  MW_INLINE Vec2 adjugate(Vec2 v) const {
    return {fms(point_.yy, v.x, point_.xy * v.y), fms(point_.xx, v.y, point_.xy * v.x)};
  }

  Float a_, b_, mass_, by_mass_;
  Vec2 arm_a_, arm_b_, apart_;
  Sym2 point_;  // K
};
MW_INLINE HeldRow<Planar> hold_turn(const JointPart& part, const Row<Planar>& s, Vec2 arm_a,
                                    Vec2 arm_b, Float, Vec2 other) {
  const PlanarPair pair(s, arm_a, arm_b);
  return part.point_hold == PointHold::line ? pair.turn_beside(other) : pair.turn();
}
MW_INLINE HeldRow<Planar> hold_slide(const JointPart& part, const Row<Planar>& s, Vec2 arm_a,
                                     Vec2 arm_b, Vec2 axis, Vec2) {
  const PlanarPair pair(s, arm_a, arm_b);
  return part.turn_hold == TurnHold::lock ? pair.slide_locked(axis) : pair.slide(axis);
}

MW_INLINE HeldRow<Tensor> hold_turn(const JointPart& part, const Row<Tensor>& s, Vec3 arm_a,
                                    Vec3 arm_b, Vec3 axis, Vec3 other) {
  const SpatialAnswers of = answers_of(s, arm_a, arm_b);
  const Sym3 by =
      part.point_hold == PointHold::line ? inverse_across(of.point, other) : inverse(of.point);
  Vec3 moment = axis;
  Mask sound = Float(Real(-1)) < Float(Real(0));
  if (part.turn_hold == TurnHold::swing) {
    const Vec3 x = mul(inverse(reduced(of.turn, of.cross, by)), axis);
    sound = Float(Real(0)) < dot(axis, x);
    moment = select(sound, x * inverse_or_zero(dot(axis, x)), axis);
  }
  const Vec3 moved = mul(of.cross, moment), force = -mul(by, moved);
  const Float free = dot(axis, mul(of.turn, axis));
  const Float k = dot(moment, mul(of.turn, moment)) + dot(moved, force);
  sound = sound & (free * of.rounding < k);
  return {select(sound, force, zero_of<Vec3>()), select(sound, moment, axis),
          select(sound, k, free)};
}
MW_INLINE HeldRow<Tensor> hold_slide(const JointPart& part, const Row<Tensor>& s, Vec3 arm_a,
                                     Vec3 arm_b, Vec3 axis, Vec3 other) {
  const SpatialAnswers of = answers_of(s, arm_a, arm_b);
  const Sym3 by =
      part.turn_hold == TurnHold::swing ? inverse_across(of.turn, other) : inverse(of.turn);
  const Vec3 x = mul(inverse(reduced(of.point, transposed(of.cross), by)), axis);
  const Float held = inverse_or_zero(dot(axis, x)), free = dot(axis, mul(of.point, axis));
  const Mask sound = free * of.rounding < held;
  const Vec3 force = select(sound, x * held, axis);
  const Vec3 moment = select(sound, -mul(by, mul_transposed(of.cross, force)), zero_of<Vec3>());
  return {force, moment, select(sound, held, free)};
}

MW_INLINE bool is_held(const JointPart& part) {
  return part.point_hold != PointHold::free || part.turn_hold != TurnHold::free;
}

// After locate. In trees the other parts are solved with the row: it keeps its own Jacobian, and K
// is what a frequency is meant of. Both arms reach the point at which the other parts act; `other`:
// Row::start_other now.
template <class S>
MW_INLINE void hold_row(const JointPart& part, typename S::Vec arm_a, typename S::Vec arm_b,
                        typename S::Vec other, Row<S>& s) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const auto force = load_as<Vec>(s.linear_b[0]);
  const auto moment = load_as<Ang>(s.moment[0]);
  const HeldRow<S> held = part.kind == PartKind::slide
                              ? hold_slide(part, s, arm_a, arm_b, force, other)
                              : hold_turn(part, s, arm_a, arm_b, moment, other);
  held.k.store(s.k);
  if (part.direct) return;
  store(s.linear_a[0], held.force), store(s.linear_b[0], held.force);
  store(s.angular_a[0], held.moment + cross(arm_a, held.force));
  store(s.angular_b[0], held.moment + cross(arm_b, held.force));
  store(s.moment[0], held.moment);
  store(s.reaction_force[0], held.force - force);
  store(s.reaction_moment[0], held.moment - moment);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
