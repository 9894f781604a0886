// What rows need to know of bodies: inverse mass and inertia, centre of mass, velocity, gravity.
#pragma once

#include "kernels/lane/ints.hpp"
#include "kernels/lane/space.hpp"
#include "kernels/work/constants.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct BodyRow {
  Float inv_mass;
  typename S::Inertia inertia;
  typename S::Vec centre;  // of mass, world; only when asked for
};

MW_INLINE void load_body_row(const Constants& t, const Work& w, const std::int32_t* o,
                             BodyRow<Planar>& r) {
  (void)t;
  load_rows4(w.body_rows, o, r.inv_mass, r.inertia, r.centre.x, r.centre.y);
}
MW_INLINE void load_body_row(const Constants& t, const Work& w, const std::int32_t* o,
                             BodyRow<Isotropic>& r) {
  Float unused0, unused1;
  load_rows4(w.body_rows, o, r.inv_mass, r.inertia, unused0, unused1);
  if (!t.collider_is_body) {
    load_rows4(w.body_rows + 4, o, r.centre.x, r.centre.y, r.centre.z, unused0);
  }
}
MW_INLINE void load_body_row(const Constants& t, const Work& w, const std::int32_t* o,
                             BodyRow<Tensor>& r) {
  Float unused;
  load_rows8(w.body_rows, o, r.inertia.xx, r.inertia.xy, r.inertia.xz, r.inertia.yy, r.inertia.yz,
             r.inertia.zz, r.inv_mass, unused);
  if (!t.collider_is_body) {
    load_rows4(w.body_rows + 8, o, r.centre.x, r.centre.y, r.centre.z, unused);
  }
}

// The pull of a point on a body at x.
template <class S>
struct Attraction {
  typename S::Vec to;        // m
  Float strength, nearness;  // with the body's gravity scale, m^3/s^2; 1 / softened distance, 1/m
  MW_INLINE Attraction(const Group& g, int body, int i, typename S::Vec x) {
    const kernels::AttractorConstants<LaneNumber>& point = constants_of_attractor(g, i);
    to.x = Float(point.position[0]) - x.x, to.y = Float(point.position[1]) - x.y;
    if constexpr (S::kDim == 3) to.z = Float(point.position[2]) - x.z;
    strength = Float(point.strength) * Float(constants_of_body(g, body).gravity_scale);
    nearness = Float(Real(1)) / sqrt(dot(to, to) + Float(point.softening2));
  }
  MW_INLINE typename S::Vec acceleration() const {
    // 0 at the point itself, where nearness is as large as it can be.
    return (((to * nearness) * nearness) * nearness) * strength;
  }
};
// Where the body is half a step on. With what substeps fall too far taken back (finish.hpp) that
// makes drift, kick, drift: position Verlet, which keeps orbits.
template <class S>
MW_INLINE typename S::Vec attraction_of_body(const Constants& t, const Group& g, int body) {
  using Vec = typename S::Vec;
  const Vec x = fma(load_as<Vec>(state_of(t, g, body, kState<S>.linear)), Float(t.dt * Real(0.5)),
                    load_as<Vec>(state_of(t, g, body, kState<S>.position)));
  Vec out = zero_of<Vec>();
  for (int i = 0; i < t.attractors; ++i) {
    out = out + Attraction<S>(g, body, i, x).acceleration();
  }
  return out;
}

// Acceleration of the bodies of the lanes by gravity.
template <class S>
MW_INLINE typename S::Vec gravity_of(const Constants& t, const Group& g, Ints bodies) {
  using OfBody = kernels::BodyConstants<LaneNumber>;
  Float a[S::kDim];
  for (int c = 0; c < S::kDim; ++c) {
    const LaneNumber& of_first = constants_of_body(g, 0).gravity[c];
    a[c] = t.uniform_gravity ? Float(of_first) : gather_numbers<OfBody>(of_first, bodies);
  }
  typename S::Vec pull;
  pull.x = a[0], pull.y = a[1];
  if constexpr (S::kDim == 3) pull.z = a[2];
  return pull;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
