// Free rotation of bodies whose inertia is not isotropic.
//
// Free bodies: DLM splitting (Dullweber, Leimkuhler, McLachlan 1997). The angular momentum L stays
// put in the world; in the body frame it is turned about x, y, z, y, x by half, half, full, half,
// half of dt L_k / I_k, and the orientation turns against it. Symplectic, |L| exact, energy
// bounded. Bodies in contact: one Newton step of the implicit gyroscopic equation in the body frame
// (Catto 2015), which loses energy but cannot gain it, since splitting would spoil solved contact
// speeds.
#pragma once

#include "kernels/lane/algebra.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kMaxTurn = Real(0.5);  // rad per splitting step, about one axis
inline constexpr int kMaxSplits = 64;

// A rotation by an angle: half-angle cosine and sine for the quaternion, whole-angle for vectors.
struct Turn {
  Float ch, sh, c, s;
};
// By Taylor series: |angle| / 2 <= 0.25, where the terms kept here are exact to rounding.
MW_INLINE Turn turn_by(Float angle) {
  const Float x = clamp(angle * Float(Real(0.5)), kMaxTurn * Real(-0.5), kMaxTurn * Real(0.5));
  const Float x2 = x * x;
  Float p, q;
  if constexpr (sizeof(Real) == 4) {
    p = fma(x2, Real(1.0 / 120.0), Real(-1.0 / 6.0));
    q = fma(x2, fma(x2, Real(-1.0 / 720.0), Real(1.0 / 24.0)), Real(-0.5));
  } else {
    p = fma(
        x2,
        fma(x2,
            fma(x2, fma(x2, Real(-1.0 / 39916800.0), Real(1.0 / 362880.0)), Real(-1.0 / 5040.0)),
            Real(1.0 / 120.0)),
        Real(-1.0 / 6.0));
    q = fma(
        x2,
        fma(x2, fma(x2, fma(x2, Real(-1.0 / 3628800.0), Real(1.0 / 40320.0)), Real(-1.0 / 720.0)),
            Real(1.0 / 24.0)),
        Real(-0.5));
  }
  const Float sh = fma(p * x2, x, x), ch = fma(q, x2, Real(1));
  const Float twice = sh + sh;
  return {ch, sh, fnma(twice, sh, Real(1)), twice * ch};
}

// L in body axes and the orientation of a body, while it is split.
struct FreeTop {
  Vec3 l;
  Quat q;
};

// One splitting step of kBodies bodies side by side: each rotation waits for the one before it, so
// a second body fills the gaps. rate_half = dt / (2 I). About axis k: l turns by -a and
// q <- q (ch, sh e_k).
template <int kBodies>
MW_INLINE void split_turn(const Vec3* rate_half, FreeTop* top) {
  const auto about_x = [&]() __attribute__((always_inline)) {
    for (int i = 0; i < kBodies; ++i) {
      Vec3& l = top[i].l;
      Quat& q = top[i].q;
      const Turn u = turn_by(rate_half[i].x * l.x);
      const Float y = fma(u.c, l.y, u.s * l.z), z = fms(u.c, l.z, u.s * l.y);
      l.y = y, l.z = z;
      q = {fms(q.w, u.ch, q.x * u.sh), fma(q.w, u.sh, q.x * u.ch), fma(q.z, u.sh, q.y * u.ch),
           fms(q.z, u.ch, q.y * u.sh)};
    }
  };
  const auto about_y = [&]() __attribute__((always_inline)) {
    for (int i = 0; i < kBodies; ++i) {
      Vec3& l = top[i].l;
      Quat& q = top[i].q;
      const Turn u = turn_by(rate_half[i].y * l.y);
      const Float z = fma(u.c, l.z, u.s * l.x), x = fms(u.c, l.x, u.s * l.z);
      l.z = z, l.x = x;
      q = {fms(q.w, u.ch, q.y * u.sh), fms(q.x, u.ch, q.z * u.sh), fma(q.w, u.sh, q.y * u.ch),
           fma(q.x, u.sh, q.z * u.ch)};
    }
  };
  about_x();
  about_y();
  for (int i = 0; i < kBodies; ++i) {
    Vec3& l = top[i].l;
    Quat& q = top[i].q;
    const Turn u = turn_by((rate_half[i].z + rate_half[i].z) * l.z);
    const Float x = fma(u.c, l.x, u.s * l.y), y = fms(u.c, l.y, u.s * l.x);
    l.x = x, l.y = y;
    q = {fms(q.w, u.ch, q.z * u.sh), fma(q.y, u.sh, q.x * u.ch), fms(q.y, u.ch, q.x * u.sh),
         fma(q.w, u.sh, q.z * u.ch)};
  }
  about_y();
  about_x();
}

// Lanes that would turn too far in one splitting step take a power of two of shorter ones; lanes
// that are done keep their bits.
inline void split_fast(Float turn, Vec3 rate_half, FreeTop& top) {
  Float splits(Real(1));
  int most = 1;
  while (most < kMaxSplits) {
    const Mask more = splits * Float(kMaxTurn) < turn;
    if (!any(more)) break;
    splits = select(more, splits + splits, splits);
    most *= 2;
  }
  const Vec3 part = rate_half * (Float(Real(1)) / splits);
  for (int i = 0; i < most; ++i) {
    const Mask running = Float(static_cast<Real>(i)) < splits;
    FreeTop next = top;
    split_turn<1>(&part, &next);
    top.l = select(running, next.l, top.l);
    top.q = select(running, next.q, top.q);
  }
}

// Moments of inertia of a body, shared by all lanes.
struct Moments {
  Vec3 inertia, inverse;
};

// Free rotation over dt of kBodies bodies. omega (world) and q become those at the end.
template <int kBodies>
MW_INLINE void rotate_free(Real dt, const Moments* moments, Vec3* omega, Quat* q) {
  FreeTop top[kBodies];
  Vec3 l_world[kBodies], rate_half[kBodies];
  Float turn[kBodies];
  Mask far = Float(Real(1)) < Float(Real(0));
  for (int i = 0; i < kBodies; ++i) {
    const Mat3 r = matrix(q[i]);
    const Vec3 w = mul_transposed(r, omega[i]);
    const Vec3 l{w.x * moments[i].inertia.x, w.y * moments[i].inertia.y,
                 w.z * moments[i].inertia.z};
    top[i] = {l, q[i]};
    l_world[i] = mul(r, l);
    rate_half[i] = moments[i].inverse * Float(dt * Real(0.5));
    // |L| / I_min bounds the rate about every axis.
    const Float inv_min =
        max(max(moments[i].inverse.x, moments[i].inverse.y), moments[i].inverse.z);
    turn[i] = sqrt(dot(l, l)) * inv_min * Float(dt);
    far = far | (Float(kMaxTurn) < turn[i]);
  }
  if (!any(far)) {
    split_turn<kBodies>(rate_half, top);
  } else {
    for (int i = 0; i < kBodies; ++i) split_fast(turn[i], rate_half[i], top[i]);
  }
  for (int i = 0; i < kBodies; ++i) {
    q[i] = normalize(top[i].q);
    // From the world's L, which does not change: rounding of the splitting leaves no trace in it.
    const Mat3 end = matrix(q[i]);
    const Vec3 l = mul_transposed(end, l_world[i]);
    omega[i] = mul(
        end, {l.x * moments[i].inverse.x, l.y * moments[i].inverse.y, l.z * moments[i].inverse.z});
  }
}

// One implicit Newton step of I w' + h w' x I w' = I w, body axes; returns the new world omega.
//   f = h w x I w,  J = I + h (skew(w) I - skew(I w)),  w' = w - J^-1 f
MW_INLINE Vec3 implicit_gyroscopic(Real dt, Vec3 inertia, const Mat3& r, Vec3 omega) {
  const Float h(dt);
  const Vec3 w = mul_transposed(r, omega);
  const Vec3 l{w.x * inertia.x, w.y * inertia.y, w.z * inertia.z};
  const Vec3 f = cross(w, l) * h;
  // Columns of J.
  const Vec3 jx{inertia.x, h * fms(w.z, inertia.x, l.z), h * fms(l.y, Real(1), w.y * inertia.x)};
  const Vec3 jy{h * fms(l.z, Real(1), w.z * inertia.y), inertia.y, h * fms(w.x, inertia.y, l.x)};
  const Vec3 jz{h * fms(w.y, inertia.z, l.y), h * fms(l.x, Real(1), w.x * inertia.z), inertia.z};
  const Vec3 yz = cross(jy, jz);
  const Float scale = Float(Real(1)) / dot(jx, yz);
  const Vec3 d{dot(f, yz) * scale, dot(jx, cross(f, jz)) * scale, dot(jx, cross(jy, f)) * scale};
  return mul(r, w - d);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
