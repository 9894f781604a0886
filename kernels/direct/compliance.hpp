// Compliances of bodies of trees: the twist about a body's centre of mass, or about an anchor, that
// a wrench there makes, all joints of the tree included (inverse of the operational-space inertia;
// Featherstone 2008, 9.5). Of the plane and of space by the same names.
#pragma once

#include "kernels/direct/spaces.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// w = angular n + mixed f, v = mixed' n + linear f.
struct SpatialCompliance {
  Sym3 angular;
  Mat3 mixed;
  Sym3 linear;
};
struct PlanarCompliance {
  Float angular;
  Vec2 mixed;
  Sym2 linear;
};
template <class S>
using ComplianceOf = std::conditional_t<kPlane<S>, PlanarCompliance, SpatialCompliance>;
template <class S>
inline constexpr int kComplianceRowsOf = kArticulatedRowsOf<S>;

MW_INLINE void load(const Real* p, SpatialCompliance& a) {
  const ArticulatedInertia rows = load_articulated(p);
  a = {rows.rotary, rows.mixed, rows.linear};
}
MW_INLINE void store(Real* p, const SpatialCompliance& a) {
  store(p, ArticulatedInertia{a.angular, a.mixed, a.linear});
}
MW_INLINE void load(const Real* p, PlanarCompliance& a) {
  a = {Float::load(p), load_vec2(p + kLanes), load_as<Sym2>(p + 3 * kLanes)};
}
MW_INLINE void store(Real* p, const PlanarCompliance& a) {
  a.angular.store(p), store(p + kLanes, a.mixed), store(p + 3 * kLanes, a.linear);
}

MW_INLINE SpatialCompliance select(Mask m, const SpatialCompliance& a, const SpatialCompliance& b) {
  return {select(m, a.angular, b.angular),
          {select(m, a.mixed.x, b.mixed.x), select(m, a.mixed.y, b.mixed.y),
           select(m, a.mixed.z, b.mixed.z)},
          select(m, a.linear, b.linear)};
}
MW_INLINE PlanarCompliance select(Mask m, const PlanarCompliance& a, const PlanarCompliance& b) {
  return {select(m, a.angular, b.angular), select(m, a.mixed, b.mixed),
          select(m, a.linear, b.linear)};
}

MW_INLINE Twist mul(const SpatialCompliance& c, const Wrench& f) {
  return {mul(c.angular, f.n) + mul(c.mixed, f.f),
          mul_transposed(c.mixed, f.n) + mul(c.linear, f.f)};
}
MW_INLINE PlanarTwist mul(const PlanarCompliance& c, PlanarWrench f) {
  return {fma(c.angular, f.n, dot(c.mixed, f.f)), fma(c.mixed, f.n, mul(c.linear, f.f))};
}

// About a point farther by r.
MW_INLINE SpatialCompliance moved(const SpatialCompliance& c, Vec3 r) {
  const Sym3& a = c.angular;
  const Vec3 x{a.xx, a.xy, a.xz}, y{a.xy, a.yy, a.yz}, z{a.xz, a.yz, a.zz};
  const Mat3 mixed{c.mixed.x + (y * r.z - z * r.y), c.mixed.y + (z * r.x - x * r.z),
                   c.mixed.z + (x * r.y - y * r.x)};
  const Mat3 p{cross(mixed.x, r), cross(mixed.y, r), cross(mixed.z, r)};
  const Mat3 q{cross(c.mixed.x, r), cross(c.mixed.y, r), cross(c.mixed.z, r)};
  const Sym3& l = c.linear;
  return {a,
          mixed,
          {l.xx + (p.x.x + q.x.x), l.xy + (p.y.x + q.x.y), l.xz + (p.z.x + q.x.z),
           l.yy + (p.y.y + q.y.y), l.yz + (p.z.y + q.y.z), l.zz + (p.z.z + q.z.z)}};
}
MW_INLINE PlanarCompliance moved(const PlanarCompliance& c, Vec2 r) {
  const Vec2 across = cross(Float(Real(1)), r);  // velocity there by a unit of rotation
  const Vec2 mixed = fma(across, c.angular, c.mixed);
  const Sym2& l = c.linear;
  return {
      c.angular,
      mixed,
      {l.xx + across.x * (mixed.x + c.mixed.x), l.xy + fma(across.x, mixed.y, across.y * c.mixed.x),
       l.yy + across.y * (mixed.y + c.mixed.y)}};
}

// c - a b' - b a'.
MW_INLINE SpatialCompliance without(const SpatialCompliance& c, const Twist& a, const Twist& b) {
  const auto both = [](const Sym3& m, Vec3 x, Vec3 y) { return fnma(y, x, fnma(x, y, m)); };
  const auto column = [&](Vec3 m, Float a_v, Float b_v) {
    return fnma(b.w, a_v, fnma(a.w, b_v, m));
  };
  return {both(c.angular, a.w, b.w),
          {column(c.mixed.x, a.v.x, b.v.x), column(c.mixed.y, a.v.y, b.v.y),
           column(c.mixed.z, a.v.z, b.v.z)},
          both(c.linear, a.v, b.v)};
}
MW_INLINE PlanarCompliance without(const PlanarCompliance& c, PlanarTwist a, PlanarTwist b) {
  const Sym2& l = c.linear;
  return {
      fnma(b.w, a.w, fnma(a.w, b.w, c.angular)),
      fnma(a.v, b.w, fnma(b.v, a.w, c.mixed)),
      {fnma(b.v.x, a.v.x, fnma(a.v.x, b.v.x, l.xx)), fnma(b.v.x, a.v.y, fnma(a.v.x, b.v.y, l.xy)),
       fnma(b.v.y, a.v.y, fnma(a.v.y, b.v.y, l.yy))}};
}

// Of a body that hangs on nothing: the inverse of its articulated inertia. Forces are eliminated
// first.
MW_INLINE SpatialCompliance compliance_of(const ArticulatedInertia& a) {
  const Sym3 l = inverse(a.linear);
  const Mat3 q{mul(a.mixed, Vec3{l.xx, l.xy, l.xz}), mul(a.mixed, Vec3{l.xy, l.yy, l.yz}),
               mul(a.mixed, Vec3{l.xz, l.yz, l.zz})};
  const Mat3& m = a.mixed;  // q m', by the entries of m
  const auto part = [&](Float Vec3::*i, Float Vec3::*j) {
    return fma(q.z.*i, m.z.*j, fma(q.y.*i, m.y.*j, q.x.*i * m.x.*j));
  };
  const Sym3& r = a.rotary;
  const Sym3 angular =
      inverse(Sym3{r.xx - part(&Vec3::x, &Vec3::x), r.xy - part(&Vec3::x, &Vec3::y),
                   r.xz - part(&Vec3::x, &Vec3::z), r.yy - part(&Vec3::y, &Vec3::y),
                   r.yz - part(&Vec3::y, &Vec3::z), r.zz - part(&Vec3::z, &Vec3::z)});
  const Mat3 mixed{-mul(angular, q.x), -mul(angular, q.y), -mul(angular, q.z)};
  return {angular,
          mixed,
          {l.xx - dot(q.x, mixed.x), l.xy - dot(q.x, mixed.y), l.xz - dot(q.x, mixed.z),
           l.yy - dot(q.y, mixed.y), l.yz - dot(q.y, mixed.z), l.zz - dot(q.z, mixed.z)}};
}
MW_INLINE PlanarCompliance compliance_of(const PlanarInertia& a) {
  const Sym2 l = inverse(a.linear);
  const Vec2 q = mul(l, a.mixed);
  const Float angular = inverse_or_zero(a.rotary - dot(a.mixed, q));
  const Vec2 mixed = q * -angular;
  return {angular,
          mixed,
          {fnma(q.x, mixed.x, l.xx), fnma(q.x, mixed.y, l.xy), fnma(q.y, mixed.y, l.yy)}};
}

MW_INLINE Twist scaled(const Twist& a, Float s) { return {a.w * s, a.v * s}; }
MW_INLINE PlanarTwist scaled(PlanarTwist a, Float s) { return {a.w * s, a.v * s}; }

// Beyond a joint that gives way along an axis, c before it: L c L' + axis axis' inverse with
// L = E - axis inverse response', where `response` and `inverse` are those of its elimination.
template <class Compliance, class T, class W>
MW_INLINE Compliance beyond(const Compliance& c, const T& axis, const W& response, Float inverse) {
  const T a = mul(c, response);
  const Float half = fma(inverse, dot(a, response), Float(Real(1))) * inverse * Float(Real(-0.5));
  return without(c, axis, fma(axis, half, scaled(a, inverse)));
}
// Beyond a joint that rotates freely. `free`: the inverse of the moments of inertia of what hangs
// on it, which `mixed` couples with forces.
MW_INLINE SpatialCompliance beyond_ball(const SpatialCompliance& c, const Sym3& free,
                                        const Mat3& mixed) {
  const Mat3 by{mul(free, mixed.x), mul(free, mixed.y), mul(free, mixed.z)};
  const Sym3& l = c.linear;
  // -by l, by its columns
  const Mat3 out{-mul(by, Vec3{l.xx, l.xy, l.xz}), -mul(by, Vec3{l.xy, l.yy, l.yz}),
                 -mul(by, Vec3{l.xz, l.yz, l.zz})};
  const auto part = [&](Float Vec3::*i, Float Vec3::*j) {  // of by l by'
    return fma(out.z.*i, by.z.*j, fma(out.y.*i, by.y.*j, out.x.*i * by.x.*j));
  };
  return {{free.xx - part(&Vec3::x, &Vec3::x), free.xy - part(&Vec3::x, &Vec3::y),
           free.xz - part(&Vec3::x, &Vec3::z), free.yy - part(&Vec3::y, &Vec3::y),
           free.yz - part(&Vec3::y, &Vec3::z), free.zz - part(&Vec3::z, &Vec3::z)},
          out,
          l};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
