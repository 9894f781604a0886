// Energy, momentum, mass centre: sums over the bodies of each lane, in their order. Bodies that
// are moved by hand (kinematic) or not there do not count.
#pragma once

#include "kernels/motion/integrate.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// What the sums need to know of a body; only here.
template <class S>
struct BodyMass {
  Float mass;
  Vec3 inertia;          // principal; planar: z
  typename S::Vec pull;  // acceleration by gravity, m/s^2

  MW_INLINE BodyMass(const Group& g, int body) {
    const auto& b = constants_of_body(g, body);
    mass = b.mass;
    inertia = {b.inertia[0], b.inertia[1], b.inertia[2]};
    pull.x = b.gravity[0], pull.y = b.gravity[1];
    if constexpr (S::kDim == 3) pull.z = b.gravity[2];
  }
};

// Angular momentum about the body's own centre, and twice the energy of its spin.
template <class S>
MW_INLINE void spin_of(const Constants& t, const Group& g, int body, const BodyMass<S>& m,
                       typename S::Ang w, typename S::Ang& momentum, Float& energy) {
  if constexpr (std::is_same_v<S, Tensor>) {
    const Quat q = load_quat(state_of(t, g, body, kState<S>.orientation));
    const Vec3 own = rotate_back(q, w);
    const Vec3 l{m.inertia.x * own.x, m.inertia.y * own.y, m.inertia.z * own.z};
    momentum = rotate(q, l);
    energy = dot(l, own);
  } else {
    momentum = w * m.inertia.z;
    energy = dot(momentum, w);
  }
}

template <class S>
void observe_motion(const Constants& t, const Group& g, kernels::Scratch*, const ObserverView& o) {
  const Float zero(Real(0)), half(Real(0.5));
  Real* rows = rows_for(o, Observer::motion);
  for (int i = 0; i < rows_of(Observer::motion); ++i) zero.store(rows + i * kLanes);
  for (int b = 0; b < t.bodies; ++b) {
    if (t.body[b].kinematic) continue;
    const BodyMass<S> m(g, b);
    const auto x = load_as<typename S::Vec>(state_of(t, g, b, kState<S>.position));
    const auto v = load_as<typename S::Vec>(state_of(t, g, b, kState<S>.linear));
    const auto w = load_as<typename S::Ang>(state_of(t, g, b, kState<S>.angular));
    const Float weight = select(absent_lanes(g, b), zero, m.mass);
    const Mask there = zero < weight;
    const auto p = v * weight;
    typename S::Ang spin;
    Float spin_energy;
    spin_of<S>(t, g, b, m, w, spin, spin_energy);
    const auto angular = select(there, spin + cross(x, p), zero_of<typename S::Ang>());
    add_to(rows, row_of(Observed::kinetic_energy),
           select(there, half * fma(weight, dot(v, v), spin_energy), zero));
    Float height = dot(m.pull, x);
    for (int i = 0; i < t.attractors; ++i) {
      const Attraction<S> at(g, b, i, x);
      height = fma(at.strength, at.nearness, height);
    }
    add_to(rows, row_of(Observed::potential_energy), -(weight * height));
    add_to(rows, row_of(Observed::total_mass), weight);
    add_to(rows, row_of(Observed::momentum), p);
    add_to(rows, row_of(Observed::angular_momentum) + (S::kDim == 2 ? 2 : 0), angular);
    add_to(rows, row_of(Observed::mass_center), x * weight);
  }
  const Float mass = Float::load(rows + row_of(Observed::total_mass) * kLanes);
  const Float share = Float(Real(1)) / select(zero < mass, mass, Float(Real(1)));
  constexpr int kCentre = row_of(Observed::mass_center);
  for (int i = kCentre; i < kCentre + 3; ++i) {
    (Float::load(rows + i * kLanes) * share).store(rows + i * kLanes);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
