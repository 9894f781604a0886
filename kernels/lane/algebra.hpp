// Small vectors, matrices and rotations of lanes. Every sum is written as a fixed chain of fma,
// so its rounding is the same everywhere.
#pragma once

#include "kernels/lane/float.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Lanes in which a vector of this squared length is no longer than `bound`, however the root of it
// is rounded. False where either leaves the range in which that can be told from the squares.
MW_INLINE Mask surely_within(Float square, Float bound) {
  return fma(square, Real(1.001), Real(1e-35)) < bound * bound;
}

// ---- plane -------------------------------------------------------------------------------------

struct Vec2 {
  Float x, y;
};
MW_INLINE Vec2 operator+(Vec2 a, Vec2 b) { return {a.x + b.x, a.y + b.y}; }
MW_INLINE Vec2 operator-(Vec2 a, Vec2 b) { return {a.x - b.x, a.y - b.y}; }
MW_INLINE Vec2 operator-(Vec2 a) { return {-a.x, -a.y}; }
MW_INLINE Vec2 operator*(Vec2 a, Float s) { return {a.x * s, a.y * s}; }
MW_INLINE Vec2 fma(Vec2 a, Float s, Vec2 c) { return {fma(a.x, s, c.x), fma(a.y, s, c.y)}; }
MW_INLINE Vec2 fnma(Vec2 a, Float s, Vec2 c) { return {fnma(a.x, s, c.x), fnma(a.y, s, c.y)}; }
MW_INLINE Float dot(Vec2 a, Vec2 b) { return fma(a.y, b.y, a.x * b.x); }
MW_INLINE Float cross(Vec2 a, Vec2 b) { return fms(a.x, b.y, a.y * b.x); }
MW_INLINE Vec2 cross(Float w, Vec2 r) { return {-(w * r.y), w * r.x}; }
MW_INLINE Vec2 select(Mask m, Vec2 a, Vec2 b) { return {select(m, a.x, b.x), select(m, a.y, b.y)}; }

struct Rot2 {  // rotation by an angle: c = cos, s = sin
  Float c, s;
};
MW_INLINE Vec2 rotate(Rot2 q, Vec2 v) {
  return {fms(q.c, v.x, q.s * v.y), fma(q.s, v.x, q.c * v.y)};
}
MW_INLINE Vec2 rotate_inverse(Rot2 q, Vec2 v) {
  return {fma(q.c, v.x, q.s * v.y), fms(q.c, v.y, q.s * v.x)};
}

// ---- space -------------------------------------------------------------------------------------

struct Vec3 {
  Float x, y, z;
};
MW_INLINE Vec3 operator+(Vec3 a, Vec3 b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
MW_INLINE Vec3 operator-(Vec3 a, Vec3 b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
MW_INLINE Vec3 operator-(Vec3 a) { return {-a.x, -a.y, -a.z}; }
MW_INLINE Vec3 operator*(Vec3 a, Float s) { return {a.x * s, a.y * s, a.z * s}; }
MW_INLINE Vec3 fma(Vec3 a, Float s, Vec3 c) {
  return {fma(a.x, s, c.x), fma(a.y, s, c.y), fma(a.z, s, c.z)};
}
MW_INLINE Vec3 fnma(Vec3 a, Float s, Vec3 c) {
  return {fnma(a.x, s, c.x), fnma(a.y, s, c.y), fnma(a.z, s, c.z)};
}
MW_INLINE Float dot(Vec3 a, Vec3 b) { return fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)); }
// By components.
MW_INLINE Vec3 times(Vec3 a, Vec3 b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
MW_INLINE Vec3 cross(Vec3 a, Vec3 b) {
  return {fms(a.y, b.z, a.z * b.y), fms(a.z, b.x, a.x * b.z), fms(a.x, b.y, a.y * b.x)};
}
MW_INLINE Vec3 select(Mask m, Vec3 a, Vec3 b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}

struct Mat3 {  // columns
  Vec3 x, y, z;
};
MW_INLINE Vec3 mul(const Mat3& m, Vec3 v) { return fma(m.z, v.z, fma(m.y, v.y, m.x * v.x)); }
MW_INLINE Vec3 mul_transposed(const Mat3& m, Vec3 v) {
  return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}

struct Sym3 {  // symmetric
  Float xx, xy, xz, yy, yz, zz;
};
MW_INLINE Vec3 mul(const Sym3& s, Vec3 v) {
  return {fma(s.xz, v.z, fma(s.xy, v.y, s.xx * v.x)), fma(s.yz, v.z, fma(s.yy, v.y, s.xy * v.x)),
          fma(s.zz, v.z, fma(s.yz, v.y, s.xz * v.x))};
}

struct Quat {  // unit quaternion w + x i + y j + z k
  Float w, x, y, z;
};
MW_INLINE Mat3 matrix(Quat q) {
  const Float x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const Float xx = q.x * x2, yy = q.y * y2, zz = q.z * z2;
  const Float xy = q.x * y2, xz = q.x * z2, yz = q.y * z2;
  const Float wx = q.w * x2, wy = q.w * y2, wz = q.w * z2;
  const Float one(Real(1));
  return {{one - (yy + zz), xy + wz, xz - wy},
          {xy - wz, one - (xx + zz), yz + wx},
          {xz + wy, yz - wx, one - (xx + yy)}};
}
MW_INLINE Float dot(Rot2 a, Rot2 b) { return fma(a.s, b.s, a.c * b.c); }
MW_INLINE Float dot(Quat a, Quat b) {
  return fma(a.w, b.w, fma(a.z, b.z, fma(a.y, b.y, a.x * b.x)));
}
MW_INLINE Quat normalize(Quat q) {
  const Float s = Float(Real(1)) / sqrt(dot(q, q));
  q = {q.w * s, q.x * s, q.y * s, q.z * s};
  // One Newton step takes off the bias of the rounding above, which else adds up over thousands of
  // steps (2e-7 of a tumbling body's energy per step in float32).
  const Float e = fma(dot(q, q), Real(-0.5), Real(0.5));
  return {fma(q.w, e, q.w), fma(q.x, e, q.x), fma(q.y, e, q.y), fma(q.z, e, q.z)};
}
MW_INLINE Quat mul(Quat a, Quat b) {
  return {fnma(a.z, b.z, fnma(a.y, b.y, fms(a.w, b.w, a.x * b.x))),
          fnma(a.z, b.y, fma(a.y, b.z, fma(a.x, b.w, a.w * b.x))),
          fnma(a.x, b.z, fma(a.z, b.x, fma(a.y, b.w, a.w * b.y))),
          fnma(a.y, b.x, fma(a.x, b.y, fma(a.z, b.w, a.w * b.z)))};
}
// The rotation b, then a.
MW_INLINE Rot2 compose(Rot2 a, Rot2 b) {
  return {fms(a.c, b.c, a.s * b.s), fma(a.s, b.c, a.c * b.s)};
}
MW_INLINE Quat compose(Quat a, Quat b) {
  return {fnma(a.z, b.z, fnma(a.y, b.y, fnma(a.x, b.x, a.w * b.w))),
          fnma(a.z, b.y, fma(a.y, b.z, fma(a.x, b.w, a.w * b.x))),
          fnma(a.x, b.z, fma(a.z, b.x, fma(a.y, b.w, a.w * b.y))),
          fnma(a.y, b.x, fma(a.x, b.y, fma(a.z, b.w, a.w * b.z)))};
}
// v rotated by a unit quaternion with vector part u: t = 2 u x v, v + w t + u x t. Fewer operations
// than by the matrix for a vector or two.
MW_INLINE Vec3 rotate_about(Float w, Vec3 u, Vec3 v) {
  const Vec3 half = cross(u, v), t = half + half, a = fma(t, w, v);
  return {fnma(u.z, t.y, fma(u.y, t.z, a.x)), fnma(u.x, t.z, fma(u.z, t.x, a.y)),
          fnma(u.y, t.x, fma(u.x, t.y, a.z))};
}
MW_INLINE Vec3 rotate(Quat q, Vec3 v) { return rotate_about(q.w, {q.x, q.y, q.z}, v); }
MW_INLINE Vec3 rotate_back(Quat q, Vec3 v) { return rotate_about(-q.w, {q.x, q.y, q.z}, v); }

// Rotation by the world vector phi: the quaternion (1, phi tan(|phi|/2)/|phi|), normalised, with
// the tangent's series cut after the sixth power (exact to 2e-6 rad at |phi| = 0.5); beyond 2 rad
// it rotates by less than asked but stays finite.
MW_INLINE Float half_tangent_ratio(Float p2) {
  const Float x = min(p2, Real(4));
  return fma(x, fma(x, fma(x, Real(17.0 / 40320.0), Real(1.0 / 240.0)), Real(1.0 / 24.0)),
             Real(0.5));
}
MW_INLINE Quat rotate_by(Quat q, Vec3 phi) {
  const Float scale = half_tangent_ratio(dot(phi, phi));
  const Vec3 h = phi * scale;
  return normalize({fnma(h.z, q.z, fnma(h.y, q.y, fnma(h.x, q.x, q.w))),
                    fms(h.y, q.z, fnma(h.x, q.w, h.z * q.y)) + q.x,
                    fms(h.z, q.x, fnma(h.y, q.w, h.x * q.z)) + q.y,
                    fms(h.x, q.y, fnma(h.z, q.w, h.y * q.x)) + q.z});
}
// R diag(d) R^T; exactly d.x E when the three entries of d are equal.
MW_INLINE Sym3 rotate_diagonal(const Mat3& r, Vec3 d) {
  const Vec3 b = r.y * (d.y - d.x), c = r.z * (d.z - d.x);
  return {fma(c.x, r.z.x, fma(b.x, r.y.x, d.x)), fma(c.x, r.z.y, b.x * r.y.y),
          fma(c.x, r.z.z, b.x * r.y.z),          fma(c.y, r.z.y, fma(b.y, r.y.y, d.x)),
          fma(c.y, r.z.z, b.y * r.y.z),          fma(c.z, r.z.z, fma(b.z, r.y.z, d.x))};
}

// The same for the plane: (c, s) rotated by phi.
MW_INLINE Rot2 rotate_by(Rot2 q, Float phi) {
  const Float t = phi * half_tangent_ratio(phi * phi);
  const Float c0 = fnma(t, t, Real(1)), s0 = t + t;
  const Float c = fms(q.c, c0, q.s * s0), s = fma(q.s, c0, q.c * s0);
  const Float k = Float(Real(1)) / sqrt(dot(Rot2{c, s}, Rot2{c, s}));
  return {c * k, s * k};
}

// One component of three, chosen per lane by an index 0, 1 or 2.
MW_INLINE Float pick(Float index, Float a, Float b, Float c) {
  return select(index == Float(Real(0)), a, select(index == Float(Real(1)), b, c));
}
MW_INLINE Vec3 pick(Float index, const Mat3& m) {
  const Mask is_x = index == Float(Real(0)), is_y = index == Float(Real(1));
  return select(is_x, m.x, select(is_y, m.y, m.z));
}

// Loads and stores of [component][lane] blocks.
MW_INLINE Vec2 load_vec2(const Real* p) { return {Float::load(p), Float::load(p + kLanes)}; }
MW_INLINE Vec3 load_vec3(const Real* p) {
  return {Float::load(p), Float::load(p + kLanes), Float::load(p + 2 * kLanes)};
}
MW_INLINE Rot2 load_rot2(const Real* p) { return {Float::load(p), Float::load(p + kLanes)}; }
MW_INLINE Quat load_quat(const Real* p) {
  return {Float::load(p), Float::load(p + kLanes), Float::load(p + 2 * kLanes),
          Float::load(p + 3 * kLanes)};
}
MW_INLINE void store(Real* p, Rot2 q) { q.c.store(p), q.s.store(p + kLanes); }
MW_INLINE void store(Real* p, Quat q) {
  q.w.store(p), q.x.store(p + kLanes), q.y.store(p + 2 * kLanes), q.z.store(p + 3 * kLanes);
}
MW_INLINE Rot2 select(Mask m, Rot2 a, Rot2 b) { return {select(m, a.c, b.c), select(m, a.s, b.s)}; }
MW_INLINE Quat select(Mask m, Quat a, Quat b) {
  return {select(m, a.w, b.w), select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
MW_INLINE void store(Real* p, Vec2 v) { v.x.store(p), v.y.store(p + kLanes); }
MW_INLINE void store(Real* p, Vec3 v) {
  v.x.store(p), v.y.store(p + kLanes), v.z.store(p + 2 * kLanes);
}

template <class T>
MW_INLINE T zero_of();
template <>
MW_INLINE Float zero_of<Float>() {
  return Real(0);
}
template <>
MW_INLINE Vec2 zero_of<Vec2>() {
  return {Real(0), Real(0)};
}
template <>
MW_INLINE Vec3 zero_of<Vec3>() {
  return {Real(0), Real(0), Real(0)};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
