// What the solve over trees of joints is written over: twists, wrenches and articulated inertias of
// the plane and of space by the same names.
#pragma once

#include "kernels/joint/passes.hpp"
#include "kernels/lane/articulated_inertia.hpp"
#include "kernels/lane/planar_inertia.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
inline constexpr bool kPlane = S::kDim == 2;
template <class S>
using TwistOf = std::conditional_t<kPlane<S>, PlanarTwist, Twist>;
template <class S>
using WrenchOf = std::conditional_t<kPlane<S>, PlanarWrench, Wrench>;
template <class S>
using ArticulatedOf = std::conditional_t<kPlane<S>, PlanarInertia, ArticulatedInertia>;
template <class S>
using MomentsOf = std::conditional_t<kPlane<S>, Float, Sym3>;  // of inertia
template <class S>
inline constexpr int kTwistRowsOf = S::kDim + S::kAng;
template <class S>
inline constexpr int kArticulatedRowsOf = kPlane<S> ? kPlanarInertiaRows : kArticulatedRows;

// Whether contacts or attached rows act on trees between two of their solves.
MW_INLINE bool are_loaded(const Constants& t) {
  return t.has_contacts || t.joint_trees.attached > 0;
}

// Calls visit(body) for all that trees move.
template <class Visit>
MW_INLINE void for_each_tree_body(const Constants& t, Visit visit) {
  for (int i = 0; i < t.joint_trees.bodies; ++i) visit(t.joint_trees.body[i]);
}

MW_INLINE void load(const Real* p, Twist& a) { a = load_twist(p); }
MW_INLINE void load(const Real* p, Wrench& a) { a = load_wrench(p); }
MW_INLINE void load(const Real* p, ArticulatedInertia& a) { a = load_articulated(p); }
MW_INLINE void load(const Real* p, PlanarTwist& a) { a = {Float::load(p), load_vec2(p + kLanes)}; }
MW_INLINE void load(const Real* p, PlanarWrench& a) { a = {Float::load(p), load_vec2(p + kLanes)}; }
MW_INLINE void load(const Real* p, PlanarInertia& a) {
  a = {Float::load(p), load_vec2(p + kLanes), load_as<Sym2>(p + 3 * kLanes)};
}
MW_INLINE void store(Real* p, PlanarTwist a) { a.w.store(p), store(p + kLanes, a.v); }
MW_INLINE void store(Real* p, PlanarWrench a) { a.n.store(p), store(p + kLanes, a.f); }
MW_INLINE void store(Real* p, const PlanarInertia& a) {
  a.rotary.store(p), store(p + kLanes, a.mixed), store(p + 3 * kLanes, a.linear);
}

MW_INLINE Twist operator-(const Twist& a, const Twist& b) { return {a.w - b.w, a.v - b.v}; }
MW_INLINE PlanarTwist operator-(PlanarTwist a, PlanarTwist b) { return {a.w - b.w, a.v - b.v}; }
MW_INLINE Twist select(Mask m, const Twist& a, const Twist& b) {
  return {select(m, a.w, b.w), select(m, a.v, b.v)};
}
MW_INLINE PlanarTwist select(Mask m, PlanarTwist a, PlanarTwist b) {
  return {select(m, a.w, b.w), select(m, a.v, b.v)};
}

// Adds to rows in some lanes.
template <int kRows, class T>
MW_INLINE void add_in_lanes(Real* to, const T& x, std::uint32_t lanes) {
  const T sum = load_as<T>(to) + x;
  if (lanes == kAllLanes) return store(to, sum);
  alignas(64) Real rows[kRows * kLanes];
  store(rows, sum);
  const Mask mask = mask_from_bits(lanes);
  for (int r = 0; r < kRows * kLanes; r += kLanes) {
    select(mask, Float::load(rows + r), Float::load(to + r)).store(to + r);
  }
}

// Of a rigid body about its centre of mass.
MW_INLINE ArticulatedInertia rigid_body(Float mass, const Sym3& rotary) {
  const Float zero(Real(0));
  const Vec3 none{zero, zero, zero};
  return {rotary, {none, none, none}, {mass, zero, zero, mass, zero, mass}};
}
MW_INLINE PlanarInertia rigid_body(Float mass, Float rotary) {
  const Float zero(Real(0));
  return {rotary, {zero, zero}, {mass, zero, mass}};
}

// inertia^-1 f: linear velocities are eliminated first.
MW_INLINE Twist solve(const ArticulatedInertia& a, const Wrench& f) {
  const Sym3 compliance = inverse(a.linear);
  const Vec3 row[3] = {{a.mixed.x.x, a.mixed.y.x, a.mixed.z.x},
                       {a.mixed.x.y, a.mixed.y.y, a.mixed.z.y},
                       {a.mixed.x.z, a.mixed.y.z, a.mixed.z.z}};
  const Vec3 by[3] = {mul(compliance, row[0]), mul(compliance, row[1]), mul(compliance, row[2])};
  const Sym3 left{a.rotary.xx - dot(row[0], by[0]), a.rotary.xy - dot(row[0], by[1]),
                  a.rotary.xz - dot(row[0], by[2]), a.rotary.yy - dot(row[1], by[1]),
                  a.rotary.yz - dot(row[1], by[2]), a.rotary.zz - dot(row[2], by[2])};
  const Vec3 w = mul(inverse(left), f.n - mul(a.mixed, mul(compliance, f.f)));
  return {w, mul(compliance, f.f - mul_transposed(a.mixed, w))};
}
MW_INLINE PlanarTwist solve(const PlanarInertia& a, PlanarWrench f) {
  const Sym2 compliance = inverse(a.linear);
  const Vec2 by = mul(compliance, a.mixed);
  const Float w = (f.n - dot(by, f.f)) * inverse_or_zero(a.rotary - dot(a.mixed, by));
  return {w, mul(compliance, fnma(a.mixed, w, f.f))};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
