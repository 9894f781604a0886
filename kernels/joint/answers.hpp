// How two bodies answer the moments and forces of a joint in space.
#pragma once

#include "kernels/joint/body.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using kernels::PointHold, kernels::TurnHold;

MW_INLINE Float sum_of(Float a, Float b) { return a + b; }
MW_INLINE Sym3 sum_of(const Sym3& a, const Sym3& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
MW_INLINE Float inverse(Float a) { return inverse_or_zero(a); }

// In space what is left of S and K is a difference: by 1 + m r^2 / I, r the arm, less than there
// was, and wrong by as much times the rounding. Where no digit is left the row knows of nothing
// else.
inline constexpr Real kHeldRounding = sizeof(Real) == 4 ? Real(1e-6) : Real(2e-15);

// The inverse over directions across a unit vector.
MW_INLINE Sym3 inverse_across(const Sym3& k, Vec3 axis) {
  const Sym3 by = inverse(k);
  const Vec3 r = mul(by, axis);
  const Float share = inverse_or_zero(dot(axis, r));
  const Vec3 s = r * share;
  return {by.xx - r.x * s.x, by.xy - r.x * s.y, by.xz - r.x * s.z,
          by.yy - r.y * s.y, by.yz - r.y * s.z, by.zz - r.z * s.z};
}
// How relative rotation and velocity of the anchors answer moments and forces.
struct SpatialAnswers {
  Sym3 turn;
  Mat3 cross;
  Sym3 point;
  Float rounding;  // of what is left of them, as a share
};
MW_INLINE SpatialAnswers answers_of(const PartBodies<Tensor>& s, Vec3 arm_a, Vec3 arm_b) {
  const Sym3 a = inertia_of(s.a), b = inertia_of(s.b);
  const auto column = [&](Vec3 of_a, Vec3 of_b) { return cross(of_b, arm_b) + cross(of_a, arm_a); };
  const Float zero(Real(0));
  SpatialAnswers out{sum_of(a, b),
                     {column({a.xx, a.xy, a.xz}, {b.xx, b.xy, b.xz}),
                      column({a.xy, a.yy, a.yz}, {b.xy, b.yy, b.yz}),
                      column({a.xz, a.yz, a.zz}, {b.xz, b.yz, b.zz})},
                     {zero, zero, zero, zero, zero, zero},
                     zero};
  add_point_mass(s.a, arm_a, out.point), add_point_mass(s.b, arm_b, out.point);
  const Float mass = Float::load(s.a.inv_mass) + Float::load(s.b.inv_mass);
  const Float trace = out.point.xx + (out.point.yy + out.point.zz);
  out.rounding = trace * inverse_or_zero(mass) * Float(kHeldRounding);
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

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
