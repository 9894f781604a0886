// Free rotation of bodies whose inertia is not isotropic.
//
// Free bodies: DLM splitting (Dullweber, Leimkuhler, McLachlan 1997). In the body frame the angular
// momentum L is rotated about x, y, z, y, x by half, half, full, half, half of dt L_k / I_k, and
// the orientation rotates against it, so that L stays put in the world. Symplectic, |L| kept to
// rounding, energy bounded. Bodies with joints, in every substep: a shorter splitting
// (split_about_y). Bodies in contact: one Newton step of the implicit gyroscopic equation in the
// body frame (Catto 2015), which loses energy but cannot gain it, since splitting would spoil
// solved contact speeds.
#pragma once

#include "kernels/lane/space.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kMaxAngle = Real(0.5);  // rad per splitting step, about one axis
inline constexpr int kMaxSplits = 64;

// sin a = a + a^3 P(a^2) and tan(a/2) = a/2 + a^3 Q(a^2) for |a| <= kMaxAngle, lowest power first.
// float: least-maximum fits, 2e-9 relative; double: Taylor's sine, fitted tangent, 2e-17.
template <class T>
struct AngleSeries;
template <>
struct AngleSeries<float> {
  static constexpr float kSine[] = {-0.16666666f, 0.0083331424f, -0.00019709355f};
  static constexpr float kTangent[] = {0.041666796f, 0.0041635458f, 0.00044289024f};
};
template <>
struct AngleSeries<double> {
  static constexpr double kSine[] = {
      -1.0 / 6,        1.0 / 120,        -1.0 / 5040,         1.0 / 362880,
      -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000};
  static constexpr double kTangent[] = {
      0.04166666666666689,   0.004166666666627725,   0.00042162698611403215, 4.271380547529701e-05,
      4.328129663073992e-06, 4.3659999157553586e-07, 4.9151856211937116e-08};
};
template <int kTerms>
MW_INLINE Float polynomial(const Real (&c)[kTerms], Float x) {
  Float sum(c[kTerms - 1]);
  for (int i = kTerms - 2; i >= 0; --i) sum = fma(sum, x, c[i]);
  return sum;
}

// A rotation by an angle: the sine for vectors, the tangent of the half angle for quaternions too.
struct HalfAngle {
  Float sine, tangent;
};
MW_INLINE HalfAngle half_angle_rotation(Float a) {
  const Float a2 = a * a, a3 = a2 * a;
  return {fma(a3, polynomial(AngleSeries<Real>::kSine, a2), a),
          fma(a3, polynomial(AngleSeries<Real>::kTangent, a2), a * Float(Real(0.5)))};
}
// (y, z) <- (c y + s z, c z - s y), from s and the tangent alone: c = 1 - s t.
MW_INLINE void rotate_back(HalfAngle u, Float& y, Float& z) {
  const Float dy = fms(u.tangent, y, z), dz = fma(u.tangent, z, y);
  y = fnma(u.sine, dy, y);
  z = fnma(u.sine, dz, z);
}

using PrincipalInertia = kernels::PrincipalInertia<LaneNumber>;

// A body while it is split: L in body axes, and the orientation.
struct Spin {
  Vec3 l;
  Quat q;
};

// About axis k: l rotates by -a and q <- q (1, t e_k), whose length grows, by at most 1.04, until
// the caller normalises it.
MW_INLINE void rotate_x(Float a, Spin& o) {
  const HalfAngle u = half_angle_rotation(a);
  rotate_back(u, o.l.y, o.l.z);
  const Float t = u.tangent;
  o.q = {fnma(t, o.q.x, o.q.w), fma(t, o.q.w, o.q.x), fma(t, o.q.z, o.q.y), fnma(t, o.q.y, o.q.z)};
}
MW_INLINE void rotate_y(Float a, Spin& o) {
  const HalfAngle u = half_angle_rotation(a);
  rotate_back(u, o.l.z, o.l.x);
  const Float t = u.tangent;
  o.q = {fnma(t, o.q.y, o.q.w), fnma(t, o.q.z, o.q.x), fma(t, o.q.w, o.q.y), fma(t, o.q.x, o.q.z)};
}
MW_INLINE void rotate_z(Float a, Spin& o) {
  const HalfAngle u = half_angle_rotation(a);
  rotate_back(u, o.l.x, o.l.y);
  const Float t = u.tangent;
  o.q = {fnma(t, o.q.z, o.q.w), fma(t, o.q.y, o.q.x), fnma(t, o.q.x, o.q.y), fma(t, o.q.w, o.q.z)};
}

// What turns angular momenta into angles of a splitting step: half of dt / I about x and y, whose
// rotations come twice, and dt / I about z.
struct Rates {
  Float x, y, z;
};
MW_INLINE Rates rates_of(const PrincipalInertia& top) {
  return {top.rate[0], top.rate[1], top.rate[2]};
}

// One splitting step of kBodies bodies side by side: each rotation waits for the one before it, so
// the others fill the gaps.
template <int kBodies>
MW_INLINE void split_rotation(const Rates* rates, Spin* o) {
  for (int i = 0; i < kBodies; ++i) rotate_x(o[i].l.x * rates[i].x, o[i]);
  for (int i = 0; i < kBodies; ++i) rotate_y(o[i].l.y * rates[i].y, o[i]);
  for (int i = 0; i < kBodies; ++i) rotate_z(o[i].l.z * rates[i].z, o[i]);
  for (int i = 0; i < kBodies; ++i) rotate_y(o[i].l.y * rates[i].y, o[i]);
  for (int i = 0; i < kBodies; ++i) rotate_x(o[i].l.x * rates[i].x, o[i]);
}

// The same about the moment of inertia of the y axis: H = |L|^2 / 2 I_y and what x and z have
// beside. The first rotates the body about L by |L| dt / I_y, which commutes with the rest: exact
// for what is symmetric about x or z, and two rotations fewer. Begins with q = 1. If y is the
// middle moment, no angle is larger than twice the body's; about a rod |L| / I is as much larger as
// the rod is long. `far`: lanes in which some angle is too large for the series.
template <int kBodies>
MW_INLINE void split_about_y(const Rates* rates, Spin* o, Mask* far) {
  const Float most(kMaxAngle);
  for (int i = 0; i < kBodies; ++i) {
    const Vec3 angle = o[i].l * (rates[i].y + rates[i].y);
    const Float square = dot(angle, angle);
    const Vec3 u = angle * half_tangent_ratio(square);
    o[i].q = {Real(1), u.x, u.y, u.z};
    far[i] = Float(4 * kMaxAngle * kMaxAngle) < square;
  }
  const auto about_x = [&](int i) __attribute__((always_inline)) {
    const Float angle = o[i].l.x * (rates[i].x - rates[i].y);
    far[i] = far[i] | (most < abs(angle));
    rotate_x(angle, o[i]);
  };
  for (int i = 0; i < kBodies; ++i) about_x(i);
  for (int i = 0; i < kBodies; ++i) {
    const Float angle = o[i].l.z * fnma(rates[i].y, Real(2), rates[i].z);
    far[i] = far[i] | (most < abs(angle));
    rotate_z(angle, o[i]);
  }
  for (int i = 0; i < kBodies; ++i) about_x(i);
}

MW_INLINE Vec3 times(Vec3 v, const LaneNumber (&c)[3]) {
  return {v.x * c[0], v.y * c[1], v.z * c[2]};
}

// Square of a bound of the angle about every axis in one step: the energy L . w stays, and of no
// axis it can be more. A bound by |L| alone is as much larger as a rod is long.
MW_INLINE Float angle2(Vec3 l, Vec3 omega, Float bound) { return dot(l, omega) * (bound * bound); }

// Lanes that would rotate too far in one splitting step take a power of two of shorter ones; lanes
// that are done keep their bits. Those too fast even for kMaxSplits rotate by less.
// `far`: angle2.
inline void split_fast(const Rates& rates, Float far, Spin& o) {
  Float splits(Real(1));
  int most = 1;
  while (most < kMaxSplits) {
    const Mask more = splits * splits * Float(kMaxAngle * kMaxAngle) < far;
    if (!any(more)) break;
    splits = select(more, splits + splits, splits);
    most *= 2;
  }
  const Float part = Float(Real(1)) / splits;
  const auto angle = [part](Float l, Float rate) __attribute__((always_inline)) {
    constexpr Real kBound = 2 * kMaxAngle;  // no lane that has enough splits reaches it
    return clamp(l * rate * part, -kBound, kBound);
  };
  for (int i = 0; i < most; ++i) {
    const Mask running = Float(static_cast<Real>(i)) < splits;
    Spin next = o;
    rotate_x(angle(o.l.x, rates.x), next);
    rotate_y(angle(next.l.y, rates.y), next);
    rotate_z(angle(next.l.z, rates.z), next);
    rotate_y(angle(next.l.y, rates.y), next);
    rotate_x(angle(next.l.x, rates.x), next);
    o.l = select(running, next.l, o.l);
    o.q = select(running, next.q, o.q);
  }
}

// Free rotation over dt of kBodies bodies. omega (world) and q become those at the end.
template <int kBodies>
MW_INLINE void rotate_free(const PrincipalInertia* const* tops, Vec3* omega, Quat* q) {
  Spin spin[kBodies];
  Rates rates[kBodies];
  Float far[kBodies];
  Mask some = Float(Real(1)) < Float(Real(0));
  for (int i = 0; i < kBodies; ++i) {
    rates[i] = rates_of(*tops[i]);
    spin[i] = {times(rotate_back(q[i], omega[i]), tops[i]->inertia), q[i]};
    far[i] = angle2(spin[i].l, times(spin[i].l, tops[i]->inverse), tops[i]->angle_bound);
    some = some | (Float(kMaxAngle * kMaxAngle) < far[i]);
  }
  if (!any(some)) {
    split_rotation<kBodies>(rates, spin);
  } else {
    for (int i = 0; i < kBodies; ++i) split_fast(rates[i], far[i], spin[i]);
  }
  for (int i = 0; i < kBodies; ++i) {
    q[i] = normalize(spin[i].q);
    omega[i] = rotate(q[i], times(spin[i].l, tops[i]->inverse));
  }
}

// Principal moments of inertia in units of the first, which is what the gyroscopic equations below
// need to know: those of a body of a millimetre are 1e-13 kg m^2, and the product of three
// underflows float32.
template <class Body>
MW_INLINE Vec3 relative_moments(const Body& body) {
  const Float unit = body.inv_inertia[0];
  return {body.inertia[0] * unit, body.inertia[1] * unit, body.inertia[2] * unit};
}

// J^-1 f with J = I + k (skew(s) I - skew(I s)), body axes: what the gyroscopic term k s x I s of a
// momentum balance adds to its derivative.
MW_INLINE Vec3 solve_gyroscopic(Vec3 inertia, Vec3 s, Vec3 l, Float k, Vec3 f) {
  // Columns of J.
  const Vec3 jx{inertia.x, k * fms(s.z, inertia.x, l.z), k * fms(l.y, Real(1), s.y * inertia.x)};
  const Vec3 jy{k * fms(l.z, Real(1), s.z * inertia.y), inertia.y, k * fms(s.x, inertia.y, l.x)};
  const Vec3 jz{k * fms(s.y, inertia.z, l.y), k * fms(l.x, Real(1), s.x * inertia.z), inertia.z};
  const Vec3 yz = cross(jy, jz);
  const Float scale = Float(Real(1)) / dot(jx, yz);
  return {dot(f, yz) * scale, dot(jx, cross(f, jz)) * scale, dot(jx, cross(jy, f)) * scale};
}

// One Newton step of implicit Euler, I w' + h w' x I w' = I w; returns the new world omega. Of what
// turns by more than a radian in the step, one step is not enough, and may end with a thousand
// times the energy: it is kept at what there was.
MW_INLINE Vec3 implicit_gyroscopic(Real dt, Vec3 inertia, const Mat3& r, Vec3 omega) {
  const Float h(dt), one(Real(1));
  const Vec3 w = mul_transposed(r, omega);
  const Vec3 l{w.x * inertia.x, w.y * inertia.y, w.z * inertia.z};
  const Vec3 next = w - solve_gyroscopic(inertia, w, l, h, cross(w, l) * h);
  const Float before = dot(w, l);
  const Float after =
      fma(next.x * next.x, inertia.x, fma(next.y * next.y, inertia.y, next.z * next.z * inertia.z));
  const Mask gains = before < after;
  const Float share = sqrt(before / select(gains, after, one));
  return mul(r, next * select(gains, share, one));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
