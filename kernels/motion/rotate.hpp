// Free rotation of bodies whose inertia is not isotropic.
//
// Free bodies: DLM splitting (Dullweber, Leimkuhler, McLachlan 1997). In the body frame the angular
// momentum L is rotated about x, y, z, y, x by half, half, full, half, half of dt L_k / I_k, and
// the orientation rotates against it, so that L stays put in the world. Symplectic, |L| kept to
// rounding, energy bounded. Bodies in contact: one Newton step of the implicit gyroscopic equation
// in the body frame (Catto 2015), which loses energy but cannot gain it, since splitting would
// spoil solved contact speeds.
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

// One splitting step of kBodies bodies side by side: each rotation waits for the one before it, so
// the others fill the gaps.
template <int kBodies>
MW_INLINE void split_rotation(const PrincipalInertia* const* top, Spin* o) {
  for (int i = 0; i < kBodies; ++i) rotate_x(o[i].l.x * top[i]->rate[0], o[i]);
  for (int i = 0; i < kBodies; ++i) rotate_y(o[i].l.y * top[i]->rate[1], o[i]);
  for (int i = 0; i < kBodies; ++i) rotate_z(o[i].l.z * top[i]->rate[2], o[i]);
  for (int i = 0; i < kBodies; ++i) rotate_y(o[i].l.y * top[i]->rate[1], o[i]);
  for (int i = 0; i < kBodies; ++i) rotate_x(o[i].l.x * top[i]->rate[0], o[i]);
}

// Square of a bound of the angle about every axis in one step.
MW_INLINE Float angle2(const PrincipalInertia& top, const Spin& o) {
  return dot(o.l, o.l) * (top.angle_bound * top.angle_bound);
}

// Lanes that would rotate too far in one splitting step take a power of two of shorter ones; lanes
// that are done keep their bits. Those too fast even for kMaxSplits rotate by less.
inline void split_fast(const PrincipalInertia& top, Spin& o) {
  const Float far = angle2(top, o);
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
    rotate_x(angle(o.l.x, top.rate[0]), next);
    rotate_y(angle(next.l.y, top.rate[1]), next);
    rotate_z(angle(next.l.z, top.rate[2]), next);
    rotate_y(angle(next.l.y, top.rate[1]), next);
    rotate_x(angle(next.l.x, top.rate[0]), next);
    o.l = select(running, next.l, o.l);
    o.q = select(running, next.q, o.q);
  }
}

MW_INLINE Vec3 times(Vec3 v, const LaneNumber (&c)[3]) {
  return {v.x * c[0], v.y * c[1], v.z * c[2]};
}

// Free rotation over dt of kBodies bodies. omega (world) and q become those at the end.
template <int kBodies>
MW_INLINE void rotate_free(const PrincipalInertia* const* tops, Vec3* omega, Quat* q) {
  Spin spin[kBodies];
  Mask far = Float(Real(1)) < Float(Real(0));
  for (int i = 0; i < kBodies; ++i) {
    spin[i] = {times(rotate_back(q[i], omega[i]), tops[i]->inertia), q[i]};
    far = far | (Float(kMaxAngle * kMaxAngle) < angle2(*tops[i], spin[i]));
  }
  if (!any(far)) {
    split_rotation<kBodies>(tops, spin);
  } else {
    for (int i = 0; i < kBodies; ++i) split_fast(*tops[i], spin[i]);
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

// Two Newton steps of the implicit midpoint rule, I (w' - w) + h/4 (w + w') x I (w + w') = 0.
MW_INLINE Vec3 midpoint_gyroscopic(Real dt, Vec3 inertia, const Mat3& r, Vec3 omega) {
  const Float k(dt * Real(0.25));
  const Vec3 w = mul_transposed(r, omega);
  Vec3 next = w;
  for (int i = 0; i < 2; ++i) {
    const Vec3 s = w + next, change = next - w;
    const Vec3 l{s.x * inertia.x, s.y * inertia.y, s.z * inertia.z};
    const Vec3 gained{change.x * inertia.x, change.y * inertia.y, change.z * inertia.z};
    next = next - solve_gyroscopic(inertia, s, l, k, fma(cross(s, l), k, gained));
  }
  return mul(r, next);
}

// The gyroscopic term of bodies on joints. Where it is slight they get half of it before the
// substeps, so that a force fixed to them is rotated by as much as it should on average; when they
// are rotated, finish keeps the angular momentum that they have without that half. Together that is
// of second order: a top nods and precesses. A little less than half takes the energy that it would
// else gain. Where the term is larger, that would not be enough: bodies of three different moments
// that tumble by a tenth of a radian in a step gain as much as they have in 20 s. They get all of
// it by implicit Euler, which wears them down.
inline constexpr Real kGyroscopicShare = Real(0.47);
inline constexpr Real kSlight = Real(0.005);  // of the angular momentum, in a step

MW_INLINE Mask is_slightly_gyroscopic(Real dt, Vec3 inertia, const Mat3& r, Vec3 omega) {
  const Vec3 w = mul_transposed(r, omega);
  const Vec3 l{w.x * inertia.x, w.y * inertia.y, w.z * inertia.z};
  const Vec3 change = cross(w, l) * Float(dt);
  return dot(change, change) < dot(l, l) * Float(kSlight * kSlight);
}
MW_INLINE Vec3 half_gyroscopic(Real dt, Vec3 inertia, const Mat3& r, Vec3 omega) {
  return midpoint_gyroscopic(dt * kGyroscopicShare, inertia, r, omega);
}
// What keeping the angular momentum may add to the energy of a step. A body that was struck after
// it had rotated, and was not rotated by what it had then, would get much more.
inline constexpr Real kMaxGain = Real(1.01);

// The angular velocity omega after a rotation from `from` to `to`, with the angular momentum of
// `before` at its start.
MW_INLINE Vec3 keep_momentum(Vec3 inertia, Quat from, Quat to, Vec3 before, Vec3 omega) {
  const Vec3 w = rotate_back(from, before);
  const Vec3 l =
      rotate_back(to, rotate(from, Vec3{w.x * inertia.x, w.y * inertia.y, w.z * inertia.z}));
  const Vec3 kept{l.x / inertia.x, l.y / inertia.y, l.z / inertia.z}, own = rotate_back(to, omega);
  const Float energy =
      fma(own.x * own.x, inertia.x, fma(own.y * own.y, inertia.y, own.z * own.z * inertia.z));
  return select(dot(l, kept) <= energy * Float(kMaxGain), rotate(to, kept), omega);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
