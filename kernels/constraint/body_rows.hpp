// What rows need to know of bodies: inverse mass and inertia, centre of mass, velocity, gravity.
#pragma once

#include "kernels/constants.hpp"
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

// Acceleration of the bodies of the lanes along n, from gravity.
template <class S>
MW_INLINE Float gravity_along(const Tables& t, const Group& g, const std::int32_t* body,
                              typename S::Vec n) {
  LaneNumber a[S::kDim];
  for (int c = 0; c < S::kDim; ++c) {
    if (t.uniform_gravity) {
      a[c] = constants_of_body(g, 0).acceleration[c];
    } else {
      for (int l = 0; l < kLanes; ++l) {
        a[c].lane[l] = constants_of_body(g, body[l]).acceleration[c].lane[l];
      }
    }
  }
  typename S::Vec pull;
  pull.x = a[0], pull.y = a[1];
  if constexpr (S::kDim == 3) pull.z = a[2];
  return dot(pull, n);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
