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

using kernels::PointHold, kernels::TurnHold;

inline constexpr Real kLeastHeld = sizeof(Real) == 4 ? Real(1e-6) : Real(1e-13);  // of K unheld

// The inverse over directions across a unit vector.
MW_INLINE Sym2 inverse_across(const Sym2& k, Vec2 axis) {
  const Vec2 d{-axis.y, axis.x};
  const Float by = inverse_or_zero(dot(d, mul(k, d)));
  return {d.x * d.x * by, d.x * d.y * by, d.y * d.y * by};
}
MW_INLINE Sym3 inverse_across(const Sym3& k, Vec3 axis) {
  const Sym3 by = inverse(k);
  const Vec3 r = mul(by, axis);
  const Float share = inverse_or_zero(dot(axis, r));
  const Vec3 s = r * share;
  return {by.xx - r.x * s.x, by.xy - r.x * s.y, by.xz - r.x * s.z,
          by.yy - r.y * s.y, by.yz - r.y * s.z, by.zz - r.z * s.z};
}
template <class Sym, class V>
MW_INLINE Sym held_inverse(PointHold hold, const Sym& k, V axis) {
  return hold == PointHold::line ? inverse_across(k, axis) : inverse(k);
}

// What a unit impulse of the row does, and its K.
template <class S>
struct HeldRow {
  typename S::Vec force;
  typename S::Ang moment;
  Float k;
};

// How relative rotation and velocity of the anchors answer moments and forces.
struct PlanarAnswers {
  Float turn;  // S
  Vec2 cross;  // D
  Sym2 point;  // K
};
MW_INLINE PlanarAnswers answers_of(const Row<Planar>& s, Vec2 arm_a, Vec2 arm_b) {
  const Float a = inertia_of(s.a), b = inertia_of(s.b), zero(Real(0));
  PlanarAnswers out{a + b, cross(b, arm_b) + cross(a, arm_a), {zero, zero, zero}};
  add_point_mass(s.a, arm_a, out.point), add_point_mass(s.b, arm_b, out.point);
  return out;
}
MW_INLINE HeldRow<Planar> hold_turn(const JointPart& part, const Row<Planar>& s, Vec2 arm_a,
                                    Vec2 arm_b, Float, Vec2 other) {
  const PlanarAnswers of = answers_of(s, arm_a, arm_b);
  const Vec2 force = -mul(held_inverse(part.point_hold, of.point, other), of.cross);
  const Float k = max(of.turn + dot(of.cross, force), of.turn * Float(kLeastHeld));
  return {force, Float(Real(1)), k};
}
MW_INLINE HeldRow<Planar> hold_slide(const JointPart& part, const Row<Planar>& s, Vec2 arm_a,
                                     Vec2 arm_b, Vec2 axis, Vec2) {
  const PlanarAnswers of = answers_of(s, arm_a, arm_b);
  const Float by = part.turn_hold == TurnHold::lock ? inverse_or_zero(of.turn) : Float(Real(0));
  const Vec2 d = of.cross, e = d * by;
  const Sym2 h{of.point.xx - d.x * e.x, of.point.xy - d.x * e.y, of.point.yy - d.y * e.y};
  const Vec2 x = mul(inverse(h), axis);
  const Float k = inverse_or_zero(dot(axis, x));
  const Vec2 force = x * k;
  return {force, -(by * dot(d, force)), k};
}

struct SpatialAnswers {
  Sym3 turn;
  Mat3 cross;
  Sym3 point;
};
MW_INLINE SpatialAnswers answers_of(const Row<Tensor>& s, Vec3 arm_a, Vec3 arm_b) {
  const Sym3 a = inertia_of(s.a), b = inertia_of(s.b);
  const auto column = [&](Vec3 of_a, Vec3 of_b) { return cross(of_b, arm_b) + cross(of_a, arm_a); };
  const Float zero(Real(0));
  SpatialAnswers out{sum_of(a, b),
                     {column({a.xx, a.xy, a.xz}, {b.xx, b.xy, b.xz}),
                      column({a.xy, a.yy, a.yz}, {b.xy, b.yy, b.yz}),
                      column({a.xz, a.yz, a.zz}, {b.xz, b.yz, b.zz})},
                     {zero, zero, zero, zero, zero, zero}};
  add_point_mass(s.a, arm_a, out.point), add_point_mass(s.b, arm_b, out.point);
  return out;
}
// a - m' by m
MW_INLINE Sym3 reduced(const Sym3& a, const Mat3& m, const Sym3& by) {
  const Vec3 x = mul(by, m.x), y = mul(by, m.y), z = mul(by, m.z);
  return {a.xx - dot(m.x, x), a.xy - dot(m.x, y), a.xz - dot(m.x, z),
          a.yy - dot(m.y, y), a.yz - dot(m.y, z), a.zz - dot(m.z, z)};
}
MW_INLINE Mat3 transposed(const Mat3& m) {
  return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
MW_INLINE HeldRow<Tensor> hold_turn(const JointPart& part, const Row<Tensor>& s, Vec3 arm_a,
                                    Vec3 arm_b, Vec3 axis, Vec3 other) {
  const SpatialAnswers of = answers_of(s, arm_a, arm_b);
  const Sym3 by = held_inverse(part.point_hold, of.point, other);
  Vec3 moment = axis;
  if (part.turn_hold == TurnHold::swing) {
    const Vec3 x = mul(inverse(reduced(of.turn, of.cross, by)), axis);
    moment = x * inverse_or_zero(dot(axis, x));
  }
  const Vec3 moved = mul(of.cross, moment), force = -mul(by, moved);
  const Float free = dot(moment, mul(of.turn, moment));
  return {force, moment, max(free + dot(moved, force), free * Float(kLeastHeld))};
}
MW_INLINE HeldRow<Tensor> hold_slide(const JointPart& part, const Row<Tensor>& s, Vec3 arm_a,
                                     Vec3 arm_b, Vec3 axis, Vec3 other) {
  const SpatialAnswers of = answers_of(s, arm_a, arm_b);
  const Sym3 by =
      part.turn_hold == TurnHold::swing ? inverse_across(of.turn, other) : inverse(of.turn);
  const Vec3 x = mul(inverse(reduced(of.point, transposed(of.cross), by)), axis);
  const Float k = inverse_or_zero(dot(axis, x));
  const Vec3 force = x * k;
  return {force, -mul(by, mul_transposed(of.cross, force)), k};
}

MW_INLINE bool is_held(const JointPart& part) {
  return !part.direct && (part.point_hold != PointHold::free || part.turn_hold != TurnHold::free);
}

// After locate. Both arms reach the point at which the other parts act; `other`: Row::start_other
// now.
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
  store(s.linear_a[0], held.force), store(s.linear_b[0], held.force);
  store(s.angular_a[0], held.moment + cross(arm_a, held.force));
  store(s.angular_b[0], held.moment + cross(arm_b, held.force));
  store(s.moment[0], held.moment);
  store(s.reaction_force[0], held.force - force);
  store(s.reaction_moment[0], held.moment - moment);
  held.k.store(s.k);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
