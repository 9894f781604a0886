// What rows need to know of bodies: inverse mass and inertia, centre of mass, velocity, gravity.
#pragma once

#include "kernels/constraint/slot.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

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

template <class S>
struct BodyRow {
  Float inv_mass;
  typename S::Inertia inertia;
  typename S::Vec centre;  // of mass, world; only when asked for
};

MW_INLINE void load_body_row(const Tables& t, const Work& w, const std::int32_t* o,
                             BodyRow<Planar>& r) {
  (void)t;
  load_rows4(w.body_rows, o, r.inv_mass, r.inertia, r.centre.x, r.centre.y);
}
MW_INLINE void load_body_row(const Tables& t, const Work& w, const std::int32_t* o,
                             BodyRow<Isotropic>& r) {
  Float unused0, unused1;
  load_rows4(w.body_rows, o, r.inv_mass, r.inertia, unused0, unused1);
  if (!t.collider_is_body) {
    load_rows4(w.body_rows + 4, o, r.centre.x, r.centre.y, r.centre.z, unused0);
  }
}
MW_INLINE void load_body_row(const Tables& t, const Work& w, const std::int32_t* o,
                             BodyRow<Tensor>& r) {
  Float unused;
  load_rows4(w.body_rows, o, r.inertia.xx, r.inertia.xy, r.inertia.xz, r.inertia.yy);
  load_rows4(w.body_rows + 4, o, r.inertia.yz, r.inertia.zz, r.inv_mass, unused);
  if (!t.collider_is_body) {
    load_rows4(w.body_rows + 8, o, r.centre.x, r.centre.y, r.centre.z, unused);
  }
}

template <class S, bool kDense>
MW_INLINE Velocity<S> load_velocity(const Work& w, const std::int32_t* offset, int body) {
  if constexpr (kDense) {
    return load_velocity_dense<S>(w.velocity + body * (S::kDim + S::kAng) * kLanes);
  } else {
    return load_velocity_row(S{}, w.velocity, offset);
  }
}

MW_INLINE Float gather(const Real* table, const std::int32_t* index) {
  alignas(64) Real x[kLanes];
  for (int l = 0; l < kLanes; ++l) x[l] = table[index[l]];
  return Float::load(x);
}

// Of the two shapes of each lane's code. kPair: A moves.
template <bool kPair>
MW_INLINE Float pair_friction(const Tables& t, std::uint32_t mask, const std::int32_t* code) {
  alignas(64) Real x[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    const int a = (code[l] & 0xffff) + (kPair ? 0 : t.colliders), b = (code[l] >> 16) & 0xffff;
    const bool there = ((mask >> l) & 1u) != 0;
    x[l] = there ? static_cast<Real>(t.friction_root[a] * t.friction_root[b]) : Real(0);
  }
  return Float::load(x);
}
template <bool kPair>
MW_INLINE Float pair_restitution(const Tables& t, std::uint32_t mask, const std::int32_t* code) {
  alignas(64) Real x[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    const int a = (code[l] & 0xffff) + (kPair ? 0 : t.colliders), b = (code[l] >> 16) & 0xffff;
    const bool there = ((mask >> l) & 1u) != 0;
    x[l] = !there                                ? Real(0)
           : t.restitution[a] > t.restitution[b] ? t.restitution[a]
                                                 : t.restitution[b];
  }
  return Float::load(x);
}

// Acceleration of the bodies of the lanes along n, from gravity.
template <class S>
MW_INLINE Float gravity_along(const Tables& t, const std::int32_t* body, typename S::Vec n) {
  typename S::Vec g;
  if (t.uniform_gravity) {
    g.x = t.body[0].acceleration[0];
    g.y = t.body[0].acceleration[1];
    if constexpr (S::kDim == 3) g.z = t.body[0].acceleration[2];
  } else {
    alignas(64) Real x[3][kLanes];
    for (int l = 0; l < kLanes; ++l) {
      for (int c = 0; c < 3; ++c) x[c][l] = t.body[body[l]].acceleration[c];
    }
    g.x = Float::load(x[0]), g.y = Float::load(x[1]);
    if constexpr (S::kDim == 3) g.z = Float::load(x[2]);
  }
  return dot(g, n);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
