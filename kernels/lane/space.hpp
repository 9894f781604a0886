// The three spaces that rows are written over: Planar (x, y, angle), Isotropic (3D, inertia a
// scalar) and Tensor (3D, inertia a symmetric matrix). A space names its vector, its angular
// vector, its inverse inertia, and how a body's velocity lies in memory:
//   dense  [body][component][lane]
//   rows   [lane][body][kRow], planar vx vy w 0, spatial vx vy vz wx | wy wz 0 0
#pragma once

#include <type_traits>

#include "kernels/data/tables.hpp"
#include "kernels/lane/algebra.hpp"
#include "kernels/lane/rows.hpp"
#include "kernels/lane/solve.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct Planar {
  using Vec = Vec2;
  using Ang = Float;
  using Orientation = Rot2;
  using Inertia = Float;
  static constexpr int kDim = 2, kAng = 1, kTangents = 1, kRow = 4, kInertia = 1, kMulti = 2;
  static constexpr auto kKind = kernels::InertiaKind::planar;
};
struct Isotropic {
  using Vec = Vec3;
  using Ang = Vec3;
  using Orientation = Quat;
  using Inertia = Float;
  static constexpr int kDim = 3, kAng = 3, kTangents = 2, kRow = 8, kInertia = 1, kMulti = 4;
  static constexpr auto kKind = kernels::InertiaKind::isotropic;
};
struct Tensor {
  using Vec = Vec3;
  using Ang = Vec3;
  using Orientation = Quat;
  using Inertia = Sym3;
  static constexpr int kDim = 3, kAng = 3, kTangents = 2, kRow = 8, kInertia = 6, kMulti = 4;
  static constexpr auto kKind = kernels::InertiaKind::tensor;
};

// The space of the shapes: of their vectors, whatever the inertia.
template <class S>
using GeometryOf = std::conditional_t<S::kDim == 2, Planar, Isotropic>;

// Inverse inertia times an angular vector.
MW_INLINE Float apply(Float inertia, Float a) { return inertia * a; }
MW_INLINE Vec3 apply(Float inertia, Vec3 a) { return a * inertia; }
MW_INLINE Vec3 apply(const Sym3& inertia, Vec3 a) { return mul(inertia, a); }

MW_INLINE Float dot(Float a, Float b) { return a * b; }

// x + a.b and w + the inverse inertia times a, in the plane rounded once.
MW_INLINE Float add_dot(Float x, Float a, Float b) { return fma(a, b, x); }
MW_INLINE Float sub_dot(Float x, Float a, Float b) { return fnma(a, b, x); }
MW_INLINE Float add_dot(Float x, Vec3 a, Vec3 b) { return x + dot(a, b); }
MW_INLINE Float sub_dot(Float x, Vec3 a, Vec3 b) { return x - dot(a, b); }
MW_INLINE Float add_applied(Float w, Float inertia, Float a) { return fma(inertia, a, w); }
MW_INLINE Float sub_applied(Float w, Float inertia, Float a) { return fnma(inertia, a, w); }
template <class Inertia>
MW_INLINE Vec3 add_applied(Vec3 w, const Inertia& inertia, Vec3 a) {
  return w + apply(inertia, a);
}
template <class Inertia>
MW_INLINE Vec3 sub_applied(Vec3 w, const Inertia& inertia, Vec3 a) {
  return w - apply(inertia, a);
}

// Loads and stores of [component][lane] blocks, by type.
MW_INLINE void load(const Real* p, Float& a) { a = Float::load(p); }
MW_INLINE void load(const Real* p, Vec2& a) { a = load_vec2(p); }
MW_INLINE void load(const Real* p, Vec3& a) { a = load_vec3(p); }
MW_INLINE void load(const Real* p, Sym3& a) {
  a = {Float::load(p),
       Float::load(p + kLanes),
       Float::load(p + 2 * kLanes),
       Float::load(p + 3 * kLanes),
       Float::load(p + 4 * kLanes),
       Float::load(p + 5 * kLanes)};
}
MW_INLINE void load(const Real* p, Sym2& a) {
  a = {Float::load(p), Float::load(p + kLanes), Float::load(p + 2 * kLanes)};
}
MW_INLINE void load(const Real* p, Rot2& a) { a = load_rot2(p); }
MW_INLINE void load(const Real* p, Quat& a) { a = load_quat(p); }
MW_INLINE void load(const Real* p, Mat3& a) {
  a = {load_vec3(p), load_vec3(p + 3 * kLanes), load_vec3(p + 6 * kLanes)};
}
// Adds to rows of lanes.
MW_INLINE void add_to(Real* rows, int row, Float x) {
  (Float::load(rows + row * kLanes) + x).store(rows + row * kLanes);
}
MW_INLINE void add_to(Real* rows, int row, Vec2 x) {
  add_to(rows, row, x.x), add_to(rows, row + 1, x.y);
}
MW_INLINE void add_to(Real* rows, int row, Vec3 x) {
  add_to(rows, row, x.x), add_to(rows, row + 1, x.y), add_to(rows, row + 2, x.z);
}

MW_INLINE void store(Real* p, Float a) { a.store(p); }
MW_INLINE void store(Real* p, const Sym2& a) {
  a.xx.store(p), a.xy.store(p + kLanes), a.yy.store(p + 2 * kLanes);
}
MW_INLINE void store(Real* p, const Sym3& a) {
  a.xx.store(p), a.xy.store(p + kLanes), a.xz.store(p + 2 * kLanes);
  a.yy.store(p + 3 * kLanes), a.yz.store(p + 4 * kLanes), a.zz.store(p + 5 * kLanes);
}
MW_INLINE void store(Real* p, const Mat3& a) {
  store(p, a.x), store(p + 3 * kLanes, a.y), store(p + 6 * kLanes, a.z);
}
template <class T>
MW_INLINE T load_as(const Real* p) {
  T a;
  load(p, a);
  return a;
}

template <class S>
struct Velocity {
  typename S::Vec v;
  typename S::Ang w;
};

template <class S>
MW_INLINE Velocity<S> load_velocity_dense(const Real* p) {
  return {load_as<typename S::Vec>(p), load_as<typename S::Ang>(p + S::kDim * kLanes)};
}
template <class S>
MW_INLINE void store_velocity_dense(Real* p, const Velocity<S>& a) {
  store(p, a.v);
  store(p + S::kDim * kLanes, a.w);
}

MW_INLINE Velocity<Planar> load_velocity_row(Planar, const Real* base, const std::int32_t* o) {
  Velocity<Planar> a;
  Float unused;
  load_rows4(base, o, a.v.x, a.v.y, a.w, unused);
  return a;
}
MW_INLINE void store_velocity_row(Planar, Real* base, const std::int32_t* o,
                                  const Velocity<Planar>& a) {
  store_rows4(base, o, a.v.x, a.v.y, a.w, Real(0));
}
template <class S>
MW_INLINE Velocity<S> load_velocity_row(S, const Real* base, const std::int32_t* o) {
  Velocity<S> a;
  Float unused0, unused1;
  load_rows8(base, o, a.v.x, a.v.y, a.v.z, a.w.x, a.w.y, a.w.z, unused0, unused1);
  return a;
}
template <class S>
MW_INLINE void store_velocity_row(S, Real* base, const std::int32_t* o, const Velocity<S>& a) {
  store_rows8(base, o, a.v.x, a.v.y, a.v.z, a.w.x, a.w.y, a.w.z, Real(0), Real(0));
}

MW_INLINE Sym3 select(Mask m, const Sym3& a, const Sym3& b) {
  return {select(m, a.xx, b.xx), select(m, a.xy, b.xy), select(m, a.xz, b.xz),
          select(m, a.yy, b.yy), select(m, a.yz, b.yz), select(m, a.zz, b.zz)};
}
MW_INLINE Mat3 select(Mask m, const Mat3& a, const Mat3& b) {
  return {select(m, a.x, b.x), select(m, a.y, b.y), select(m, a.z, b.z)};
}
template <class S>
MW_INLINE Velocity<S> select(Mask m, const Velocity<S>& a, const Velocity<S>& b) {
  return {select(m, a.v, b.v), select(m, a.w, b.w)};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
