// What impulses of a contact do to the bodies at its sides, and how fast those are along its rows.
#pragma once

#include "kernels/rows/contact_block.hpp"
#include "kernels/rows/velocities.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <int N>
MW_INLINE Float sum_of(const Float* x) {
  Float sum = x[0];
  for (int i = 1; i < N; ++i) sum = sum + x[i];
  return sum;
}

// ---- along the normal --------------------------------------------------------------------------

// The moment of impulses d[i] along the normal at all points, about the centre of mass.
template <class S, int N>
MW_INLINE typename S::Ang normal_moment(const ContactSide<S, N, Free>& side, const Float* d) {
  using Ang = typename S::Ang;
  Ang moment = load_as<Ang>(side.arm[0][0]) * d[0];
  for (int i = 1; i < N; ++i) moment = fma(load_as<Ang>(side.arm[i][0]), d[i], moment);
  return moment;
}

// Applies normal impulses d[i] at all points.
template <class S, int N, class A, class Velocities>
MW_INLINE void apply_normal(const SidedBlock<S, N, A>& s, const Float* d, Velocities& v) {
  const auto n = load_as<typename S::Vec>(s.normal[0]);
  const Float sum = sum_of<N>(d);
  add_impulse(s.b, n, sum, normal_moment(s.b, d), v.b);
  if constexpr (A::kMoves) take_impulse(s.a, n, sum, normal_moment(s.a, d), v.a);
}

// The speed of B against A along the normal at point i; x: what it is on top of, along the normal.
template <class S, int N, class A, class Velocities>
MW_INLINE Float normal_speed(const SidedBlock<S, N, A>& s, int i, const Velocities& v, Float x) {
  using Ang = typename S::Ang;
  x = add_dot(x, load_as<Ang>(s.b.arm[i][0]), v.b.w);
  if constexpr (A::kMoves) x = sub_dot(x, load_as<Ang>(s.a.arm[i][0]), v.a.w);
  return x;
}
template <class S, int N, class A, class Velocities>
MW_INLINE void normal_speeds(const SidedBlock<S, N, A>& s, const Velocities& v, Float* speed) {
  const Float along = dot(load_as<typename S::Vec>(s.normal[0]), relative_velocity(v.a, v.b));
  for (int i = 0; i < N; ++i) speed[i] = normal_speed(s, i, v, along);
}

// ---- along the tangents ------------------------------------------------------------------------

// In the plane: x, and how fast B slips against A along the tangent by rotation.
template <int N, class A, class Velocities>
MW_INLINE Float add_spin_slip(const SidedBlock<Planar, N, A>& s, const Velocities& v, Float x) {
  x = fma(Float::load(s.b.friction_arm[0]), v.b.w, x);
  if constexpr (A::kMoves) x = fnma(Float::load(s.a.friction_arm[0]), v.a.w, x);
  return x;
}
// The speed of B against A along the tangent at the friction centre.
template <int N, class A, class Velocities>
MW_INLINE Float slip_of(const SidedBlock<Planar, N, A>& s, const Velocities& v) {
  const Float along = cross(load_as<Vec2>(s.normal[0]), relative_velocity(v.a, v.b));
  return add_spin_slip(s, v, along);
}
// In space: their velocity there.
template <class S, int N, class A, class Velocities>
MW_INLINE Vec3 slip_of(const SidedBlock<S, N, A>& s, const Velocities& v) {
  Vec3 slip = point_velocity(v.b, load_as<Vec3>(s.b.friction_arm[0]));
  if constexpr (A::kMoves) slip = slip - point_velocity(v.a, load_as<Vec3>(s.a.friction_arm[0]));
  return slip;
}
// A slip along either tangent.
template <class Block>
MW_INLINE Float along_tangent(const Block&, int, Float slip) {
  return slip;
}
template <class Block>
MW_INLINE Float along_tangent(const Block& s, int i, Vec3 slip) {
  const auto t = load_as<Vec3>(s.tangent[0]);
  return dot(i == 0 ? t : cross(load_as<Vec3>(s.normal[0]), t), slip);
}

// Applies friction impulses d along the tangents, and a twist about the normal.
template <int N, class A, class Velocities>
MW_INLINE void apply_friction(const SidedBlock<Planar, N, A>& s, const Float* d, Float,
                              Velocities& v) {
  const auto n = load_as<Vec2>(s.normal[0]);
  const Vec2 t{-n.y, n.x};
  add_impulse(s.b, t, d[0], Float::load(s.b.friction_arm[0]) * d[0], v.b);
  if constexpr (A::kMoves) take_impulse(s.a, t, d[0], Float::load(s.a.friction_arm[0]) * d[0], v.a);
}
template <class S, int N, class A, class Velocities>
MW_INLINE void apply_friction(const SidedBlock<S, N, A>& s, const Float* d, Float twist,
                              Velocities& v) {
  const auto n = load_as<Vec3>(s.normal[0]), t = load_as<Vec3>(s.tangent[0]);
  const Vec3 p = fma(cross(n, t), d[1], t * d[0]);
  const auto moment = [&](const ContactSide<S, N, Free>& side) {
    const Vec3 of_p = cross(load_as<Vec3>(side.friction_arm[0]), p);
    return ContactBlock<S, N>::kTwist ? fma(n, twist, of_p) : of_p;
  };
  add_impulse(s.b, p, moment(s.b), v.b);
  if constexpr (A::kMoves) take_impulse(s.a, p, moment(s.a), v.a);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
