// Friction rows of a block: at the mean of its points, along one tangent (planar) or two (spatial),
// and for spatial manifolds of several points about the normal.
#pragma once

#include "kernels/rows/sides.hpp"
#include "kernels/rows/stored_impulses.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Where friction acts, from the centres of mass.
template <class S>
struct FrictionCentre {
  typename S::Vec a, b;
};

template <int N, class A>
MW_INLINE void put_tangents(const Sides<Planar, A>& sides, const Manifold<Planar, N>&, Mask active,
                            Vec2 normal, const FrictionCentre<Planar>& centre,
                            SidedBlock<Planar, N, A>& s) {
  const Float zero(Real(0)), one(Real(1));
  const Vec2 tangent{-normal.y, normal.x};
  store(s.tangent[0], tangent);
  const Float b = cross(centre.b, tangent);
  b.store(s.b.friction_arm[0]);
  Float k = sides.inv_mass() + b * apply(sides.b.body.inertia, b);
  if constexpr (A::kMoves) {
    const Float a = cross(centre.a, tangent);
    a.store(s.a.friction_arm[0]);
    k = k + a * apply(sides.a.body.inertia, a);
  }
  select(active, one / k, zero).store(s.tangent_mass[0]);
}

// The two tangents share one effective mass, the inverse of a 2x2 matrix. A scalar one brakes
// what slips.
template <class S, int N, class A>
MW_INLINE void put_tangents(const Sides<S, A>& sides, const Manifold<GeometryOf<S>, N>& m,
                            Mask active, Vec3 normal, const FrictionCentre<S>& centre,
                            SidedBlock<S, N, A>& s) {
  const Float zero(Real(0)), one(Real(1)), inv_mass = sides.inv_mass();
  const Vec3 tangent = select(active, m.tangent, zero_of<Vec3>());
  const Vec3 second = cross(normal, tangent);
  store(s.tangent[0], tangent);
  store(s.b.friction_arm[0], centre.b);
  if constexpr (A::kMoves) store(s.a.friction_arm[0], centre.a);
  const Vec3 b1 = cross(centre.b, tangent), b2 = cross(centre.b, second);
  const Vec3 i1 = apply(sides.b.body.inertia, b1), i2 = apply(sides.b.body.inertia, b2);
  Float k11 = inv_mass + dot(b1, i1), k12 = dot(b1, i2), k22 = inv_mass + dot(b2, i2);
  if constexpr (A::kMoves) {
    const Vec3 a1 = cross(centre.a, tangent), a2 = cross(centre.a, second);
    const Vec3 j1 = apply(sides.a.body.inertia, a1), j2 = apply(sides.a.body.inertia, a2);
    k11 = k11 + dot(a1, j1);
    k12 = k12 + dot(a1, j2);
    k22 = k22 + dot(a2, j2);
  }
  const Float scale = select(active, one / fms(k11, k22, k12 * k12), zero);
  (k22 * scale).store(s.tangent_mass[0]);
  (-(k12 * scale)).store(s.tangent_mass[1]);
  (k11 * scale).store(s.tangent_mass[2]);
  // The harmonic mean of its eigenvalues, less than twice the smaller one: steps by it converge.
  select(active, Float(Real(2)) / (k11 + k22), zero).store(s.slip_mass);
}

template <class S, int N, class A>
MW_INLINE void put_twist(const Sides<S, A>& sides, const Manifold<GeometryOf<S>, N>& m, Mask active,
                         typename S::Vec normal, const FrictionCentre<S>& centre, Float impulse,
                         SidedBlock<S, N, A>& s) {
  const Float zero(Real(0)), one(Real(1));
  Float k = dot(normal, apply(sides.b.body.inertia, normal));
  if constexpr (A::kMoves) k = k + dot(normal, apply(sides.a.body.inertia, normal));
  select(active, one / k, zero).store(s.twist_mass);
  select(active, impulse, zero).store(s.twist_impulse);
  for (int i = 0; i < N; ++i) {
    const auto d = m.point_b[i] - centre.b;
    select(m.valid[i], sqrt(dot(d, d)), zero).store(s.twist_arm[i]);
  }
}

// `sum`: of the anchors of the points, of which there are `count`.
template <class S, int N, class A>
MW_INLINE void put_friction(const Constants& t, const Group& g, const Sides<S, A>& sides,
                            const std::int32_t* code, const Manifold<GeometryOf<S>, N>& m,
                            Mask active, const FrictionCentre<S>& sum, Float count,
                            const StoredImpulses<N>& stored, SidedBlock<S, N, A>& s) {
  const Float zero(Real(0)), one(Real(1));
  MaterialPair mu;
  if (t.uniform_friction) {
    mu.a = mu.b = Float(materials(g)->friction);
  } else {
    mu = load_materials<A>(t, g, code, s.mask, &Material::friction);
  }
  sqrt(mu.a * mu.b).store(s.friction);
  const auto normal = load_as<typename S::Vec>(s.normal[0]);
  const Float share = one / max(count, one);
  FrictionCentre<S> centre;
  centre.b = sum.b * share;
  if constexpr (A::kMoves) {
    centre.a = sum.a * share;
    // What rides on a driven body turns with it: there the arm is that of half a step on. With the
    // arm of the step's start a rider would leave a turntable by w^2 r dt / 2 in the mean.
    const Mask drives_a = sides.a.body.inv_mass == zero, drives_b = sides.b.body.inv_mass == zero;
    auto way = (sides.b.velocity.v - sides.a.velocity.v) * Float(t.dt * Real(0.5));
    way = way - normal * dot(normal, way);
    centre.a = select(drives_a, centre.a + way, centre.a);
    centre.b = select(drives_b, centre.b - way, centre.b);
  }
  put_tangents(sides, m, active, normal, centre, s);
  for (int i = 0; i < S::kTangents; ++i) {
    select(active, stored.tangent[i], zero).store(s.tangent_impulse[i]);
  }
  if constexpr (S::kDim == 3 && N > 1) {
    put_twist(sides, m, active, normal, centre, stored.twist, s);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
