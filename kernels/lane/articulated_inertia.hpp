// Inertias of articulated bodies: symmetric, and other along each axis, since dofs give way
// (Featherstone 2008, 7.1).
#pragma once

#include "kernels/lane/spatial.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A symmetric 6 x 6 matrix: of a twist the moment `rotary` w + `mixed` v, and the force `mixed`' w
// + `linear` v.
struct ArticulatedInertia {
  Sym3 rotary;
  Mat3 mixed;
  Sym3 linear;
};

MW_INLINE ArticulatedInertia load_articulated(const Real* p) {
  return {load_as<Sym3>(p),
          {load_vec3(p + 6 * kLanes), load_vec3(p + 9 * kLanes), load_vec3(p + 12 * kLanes)},
          load_as<Sym3>(p + 15 * kLanes)};
}
MW_INLINE void store(Real* p, const ArticulatedInertia& a) {
  store(p, a.rotary), store(p + 15 * kLanes, a.linear);
  store(p + 6 * kLanes, a.mixed.x), store(p + 9 * kLanes, a.mixed.y);
  store(p + 12 * kLanes, a.mixed.z);
}
MW_INLINE ArticulatedInertia operator+(const ArticulatedInertia& a, const ArticulatedInertia& b) {
  return {a.rotary + b.rotary,
          {a.mixed.x + b.mixed.x, a.mixed.y + b.mixed.y, a.mixed.z + b.mixed.z},
          a.linear + b.linear};
}
MW_INLINE Wrench mul(const ArticulatedInertia& a, const Twist& x) {
  return {mul(a.rotary, x.w) + mul(a.mixed, x.v),
          mul_transposed(a.mixed, x.w) + mul(a.linear, x.v)};
}
MW_INLINE Sym3 fnma(Vec3 a, Vec3 b, const Sym3& c) {
  return {fnma(a.x, b.x, c.xx), fnma(a.x, b.y, c.xy), fnma(a.x, b.z, c.xz),
          fnma(a.y, b.y, c.yy), fnma(a.y, b.z, c.yz), fnma(a.z, b.z, c.zz)};
}
// a - f f' scale.
MW_INLINE ArticulatedInertia without(const ArticulatedInertia& a, const Wrench& f, Float scale) {
  const Vec3 n = f.n * scale, l = f.f * scale;
  return {fnma(f.n, n, a.rotary),
          {fnma(f.n, l.x, a.mixed.x), fnma(f.n, l.y, a.mixed.y), fnma(f.n, l.z, a.mixed.z)},
          fnma(f.f, l, a.linear)};
}
// Of a rigid body. No entry is -0: adding the +0 of other lanes' contacts changes nothing.
MW_INLINE ArticulatedInertia articulated(const SpatialInertia& i) {
  const Float zero(Real(0));
  const Vec3 h{i.moment.x + zero, i.moment.y + zero, i.moment.z + zero};
  const Vec3 minus{zero - h.x, zero - h.y, zero - h.z};
  return {{i.rotary.xx, i.rotary.xy + zero, i.rotary.xz + zero, i.rotary.yy, i.rotary.yz + zero,
           i.rotary.zz},
          {{zero, h.z, minus.y}, {minus.z, zero, h.x}, {h.y, minus.x, zero}},
          {i.mass, zero, zero, i.mass, zero, i.mass}};
}
// Of a spring at r that resists displacements of its point by `stiffness`.
MW_INLINE ArticulatedInertia spring_at(Vec3 r, const Sym3& k) {
  const Mat3 mixed{cross(r, {k.xx, k.xy, k.xz}), cross(r, {k.xy, k.yy, k.yz}),
                   cross(r, {k.xz, k.yz, k.zz})};
  const Vec3 x = cross(r, {mixed.x.x, mixed.y.x, mixed.z.x});
  const Vec3 y = cross(r, {mixed.x.y, mixed.y.y, mixed.z.y});
  const Vec3 z = cross(r, {mixed.x.z, mixed.y.z, mixed.z.z});
  return {{x.x, x.y, x.z, y.y, y.z, z.z}, mixed, k};
}

// About a point farther by -o.
MW_INLINE ArticulatedInertia moved_back(const ArticulatedInertia& a, Vec3 o) {
  const Sym3& l = a.linear;
  const Mat3 mixed{a.mixed.x + cross(o, {l.xx, l.xy, l.xz}),
                   a.mixed.y + cross(o, {l.xy, l.yy, l.yz}),
                   a.mixed.z + cross(o, {l.xz, l.yz, l.zz})};
  const auto around = [&](const Mat3& m) {  // its rows
    return Mat3{cross(o, {m.x.x, m.y.x, m.z.x}), cross(o, {m.x.y, m.y.y, m.z.y}),
                cross(o, {m.x.z, m.y.z, m.z.z})};
  };
  const Mat3 p = around(mixed), q = around(a.mixed);
  return {
      {a.rotary.xx + (p.x.x + q.x.x), a.rotary.xy + (p.x.y + q.y.x), a.rotary.xz + (p.x.z + q.z.x),
       a.rotary.yy + (p.y.y + q.y.y), a.rotary.yz + (p.y.z + q.z.y), a.rotary.zz + (p.z.z + q.z.z)},
      mixed,
      l};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
