// Spatial vectors and inertias in world axes about a point (Featherstone 2008).
#pragma once

#include "kernels/lane/space.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Velocity or acceleration: angular, and linear of the body's point at the reference point.
struct Twist {
  Vec3 w, v;
};
// Moment about the reference point, and force.
struct Wrench {
  Vec3 n, f;
};
MW_INLINE Twist operator+(const Twist& a, const Twist& b) { return {a.w + b.w, a.v + b.v}; }
MW_INLINE Twist fma(const Twist& a, Float s, const Twist& c) {
  return {fma(a.w, s, c.w), fma(a.v, s, c.v)};
}
MW_INLINE Wrench operator+(const Wrench& a, const Wrench& b) { return {a.n + b.n, a.f + b.f}; }
MW_INLINE Wrench operator-(const Wrench& a, const Wrench& b) { return {a.n - b.n, a.f - b.f}; }
MW_INLINE Wrench fma(const Wrench& a, Float s, const Wrench& c) {
  return {fma(a.n, s, c.n), fma(a.f, s, c.f)};
}
MW_INLINE Wrench fnma(const Wrench& a, Float s, const Wrench& c) {
  return {fnma(a.n, s, c.n), fnma(a.f, s, c.f)};
}
MW_INLINE Float dot(const Twist& a, const Wrench& b) { return dot(a.w, b.n) + dot(a.v, b.f); }
// Rate of a twist that a body carries with it, and of a wrench.
MW_INLINE Twist cross(const Twist& a, const Twist& b) {
  return {cross(a.w, b.w), cross(a.w, b.v) + cross(a.v, b.w)};
}
MW_INLINE Wrench cross(const Twist& a, const Wrench& b) {
  return {cross(a.w, b.n) + cross(a.v, b.f), cross(a.w, b.f)};
}

// Mass, mass times centre of mass, and moments of inertia about the reference point.
struct SpatialInertia {
  Float mass;
  Vec3 moment;
  Sym3 rotary;
};
MW_INLINE Sym3 operator+(const Sym3& a, const Sym3& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
MW_INLINE SpatialInertia operator+(const SpatialInertia& a, const SpatialInertia& b) {
  return {a.mass + b.mass, a.moment + b.moment, a.rotary + b.rotary};
}
MW_INLINE Wrench mul(const SpatialInertia& i, const Twist& a) {
  return {mul(i.rotary, a.w) + cross(i.moment, a.v), fma(a.v, i.mass, cross(a.w, i.moment))};
}
// Of a body of that mass with its centre at c and moments about it in world axes.
MW_INLINE SpatialInertia spatial_inertia(Float mass, Vec3 c, const Sym3& moments) {
  const Vec3 h = c * mass;
  return {mass,
          h,
          {fma(h.z, c.z, fma(h.y, c.y, moments.xx)), fnma(h.x, c.y, moments.xy),
           fnma(h.x, c.z, moments.xz), fma(h.z, c.z, fma(h.x, c.x, moments.yy)),
           fnma(h.y, c.z, moments.yz), fma(h.y, c.y, fma(h.x, c.x, moments.zz))}};
}

// About a point farther by r.
MW_INLINE Twist moved(const Twist& a, Vec3 r) { return {a.w, a.v + cross(a.w, r)}; }
MW_INLINE Wrench moved(const Wrench& a, Vec3 r) { return {a.n + cross(a.f, r), a.f}; }
MW_INLINE SpatialInertia moved(const SpatialInertia& i, Vec3 r) {
  const Vec3 h = fnma(r, i.mass, i.moment), both = i.moment + h;
  const Vec3 x = both * r.x, y = both * r.y, z = both * r.z;
  const Float half(Real(0.5));
  return {i.mass,
          h,
          {i.rotary.xx - (y.y + z.z), fma(half, x.y + y.x, i.rotary.xy),
           fma(half, x.z + z.x, i.rotary.xz), i.rotary.yy - (x.x + z.z),
           fma(half, y.z + z.y, i.rotary.yz), i.rotary.zz - (x.x + y.y)}};
}

inline constexpr int kTwistRows = 6, kInertiaRows = 10, kArticulatedRows = 21;
MW_INLINE Twist load_twist(const Real* p) { return {load_vec3(p), load_vec3(p + 3 * kLanes)}; }
MW_INLINE void store(Real* p, const Twist& a) { store(p, a.w), store(p + 3 * kLanes, a.v); }
MW_INLINE Wrench load_wrench(const Real* p) { return {load_vec3(p), load_vec3(p + 3 * kLanes)}; }
MW_INLINE void store(Real* p, const Wrench& a) { store(p, a.n), store(p + 3 * kLanes, a.f); }
MW_INLINE SpatialInertia load_inertia(const Real* p) {
  return {Float::load(p), load_vec3(p + kLanes), load_as<Sym3>(p + 4 * kLanes)};
}
MW_INLINE void store(Real* p, const SpatialInertia& a) {
  a.mass.store(p), store(p + kLanes, a.moment), store(p + 4 * kLanes, a.rotary);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
