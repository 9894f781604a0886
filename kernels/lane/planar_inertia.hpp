// Twists, wrenches and inertias of articulated bodies in the plane: what spatial.hpp and
// articulated_inertia.hpp are in space, by the same names.
#pragma once

#include "kernels/lane/space.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct PlanarTwist {
  Float w;
  Vec2 v;
};
struct PlanarWrench {
  Float n;
  Vec2 f;
};
MW_INLINE PlanarTwist operator+(PlanarTwist a, PlanarTwist b) { return {a.w + b.w, a.v + b.v}; }
MW_INLINE PlanarTwist fma(PlanarTwist a, Float s, PlanarTwist c) {
  return {fma(a.w, s, c.w), fma(a.v, s, c.v)};
}
MW_INLINE PlanarWrench operator+(PlanarWrench a, PlanarWrench b) { return {a.n + b.n, a.f + b.f}; }
MW_INLINE PlanarWrench operator-(PlanarWrench a, PlanarWrench b) { return {a.n - b.n, a.f - b.f}; }
MW_INLINE PlanarWrench fnma(PlanarWrench a, Float s, PlanarWrench c) {
  return {fnma(a.n, s, c.n), fnma(a.f, s, c.f)};
}
MW_INLINE Float dot(PlanarTwist a, PlanarWrench b) { return fma(a.w, b.n, dot(a.v, b.f)); }

// About a point farther by r.
MW_INLINE PlanarTwist moved(PlanarTwist a, Vec2 r) { return {a.w, a.v + cross(a.w, r)}; }
MW_INLINE PlanarWrench moved(PlanarWrench a, Vec2 r) { return {a.n + cross(a.f, r), a.f}; }

// A symmetric 3 x 3 matrix: of a twist the moment `rotary` w + `mixed` . v, and the force `mixed` w
// + `linear` v.
struct PlanarInertia {
  Float rotary;
  Vec2 mixed;
  Sym2 linear;
};
inline constexpr int kPlanarTwistRows = 3, kPlanarInertiaRows = 6;

MW_INLINE Sym2 operator+(const Sym2& a, const Sym2& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}
MW_INLINE PlanarInertia operator+(const PlanarInertia& a, const PlanarInertia& b) {
  return {a.rotary + b.rotary, a.mixed + b.mixed, a.linear + b.linear};
}
MW_INLINE PlanarWrench mul(const PlanarInertia& a, PlanarTwist x) {
  return {fma(a.rotary, x.w, dot(a.mixed, x.v)), fma(a.mixed, x.w, mul(a.linear, x.v))};
}
// a - f f' scale.
MW_INLINE PlanarInertia without(const PlanarInertia& a, PlanarWrench f, Float scale) {
  const Float n = f.n * scale;
  const Vec2 l = f.f * scale;
  return {fnma(f.n, n, a.rotary),
          fnma(f.f, n, a.mixed),
          {fnma(f.f.x, l.x, a.linear.xx), fnma(f.f.x, l.y, a.linear.xy),
           fnma(f.f.y, l.y, a.linear.yy)}};
}
// About a point farther by -o.
MW_INLINE PlanarInertia moved_back(const PlanarInertia& a, Vec2 o) {
  const Vec2 across = cross(Float(Real(1)), o);
  const Vec2 mixed = a.mixed + mul(a.linear, across);
  return {a.rotary + (dot(across, a.mixed) + dot(across, mixed)), mixed, a.linear};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
