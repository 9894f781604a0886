// The integrators: one step of h of a whole group, from and to FlightWork::now.
#pragma once

#include "kernels/flight/implicit.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
void explicit_euler(const Constants& t, const Group& g, Work& w) {
  FlightWork& f = w.flight;
  find_rates<S>(t, g, f.now, f.rate, Real(0), true);
  move_by<S>(t, f.now, f.rate, Float(t.h), f.now);
}

template <class S>
void symplectic_euler(const Constants& t, const Group& g, Work& w) {
  FlightWork& f = w.flight;
  accelerate<S, true>(t, g, f.now, f.rate);
  change_velocities<S>(t, f.now, f.rate, Float(t.h), f.now);
  go_on<S>(t, g, f.now, Float(t.h));
}

// Free flight over `share` of h.
template <class S>
void drift(const Constants& t, const Group& g, FlightWork& f, Real share) {
  const Float h(t.h * share), of_step(share / static_cast<Real>(t.substeps));
  for (int b = 0; b < t.bodies; ++b) {
    Motion<S> m = load_motion<S>(t, f.now, b);
    m.x = fma(m.v, h, m.x);
    if constexpr (S::kDim == 2) {
      if (t.has_orientation) m.q = rotate_by(m.q, m.spin * h);
    } else if (t.has_orientation) {
      PrincipalInertia top = constants_of_body(g, b).principal;
      for (int c = 0; c < 3; ++c) (Float(top.rate[c]) * of_step).store(top.rate[c].lane);
      (Float(top.angle_bound) * of_step).store(top.angle_bound.lane);
      const PrincipalInertia* tops[1] = {&top};
      const Vec3 before = m.spin;
      rotate_free<1>(tops, &m.spin, &m.q);
      if (t.body[b].kinematic) m.spin = before;
    }
    store_motion(t, f.now, b, m);
  }
}
// What the forces do to velocities over `share` of h; where they depend on them, by the midpoint.
template <class S>
void kick(const Constants& t, const Group& g, FlightWork& f, Real share) {
  const Real h = t.h * share;
  accelerate<S, false>(t, g, f.now, f.rate);
  if (t.flight.damped) {
    copy_motion(t, f.base, f.now);
    change_velocities<S>(t, f.base, f.rate, Float(h * Real(0.5)), f.now);
    accelerate<S, false>(t, g, f.now, f.rate);
    change_velocities<S>(t, f.base, f.rate, Float(h), f.now);
  } else {
    change_velocities<S>(t, f.now, f.rate, Float(h), f.now);
  }
}

template <class S>
void verlet(const Constants& t, const Group& g, Work& w) {
  drift<S>(t, g, w.flight, Real(0.5));
  kick<S>(t, g, w.flight, Real(1));
  drift<S>(t, g, w.flight, Real(0.5));
}
template <class S>
void velocity_verlet(const Constants& t, const Group& g, Work& w) {
  kick<S>(t, g, w.flight, Real(0.5));
  drift<S>(t, g, w.flight, Real(1));
  kick<S>(t, g, w.flight, Real(0.5));
}

template <class S>
void runge_kutta4(const Constants& t, const Group& g, Work& w) {
  FlightWork& f = w.flight;
  const Float h(t.h), half(t.h * Real(0.5));
  const int size = t.bodies * t.state_stride * kLanes;
  const auto add = [&](Real weight) {
    for (int i = 0; i < size; i += kLanes) {
      fma(Float::load(f.rate + i), Float(weight), Float::load(f.sum + i)).store(f.sum + i);
    }
  };
  copy_motion(t, f.base, f.now);
  find_rates<S>(t, g, f.now, f.rate, Real(0), true);
  copy_motion(t, f.sum, f.rate);
  move_by<S>(t, f.base, f.rate, half, f.now);
  find_rates<S>(t, g, f.now, f.rate, half, false);
  add(Real(2));
  move_by<S>(t, f.base, f.rate, half, f.now);
  find_rates<S>(t, g, f.now, f.rate, half, false);
  add(Real(2));
  move_by<S>(t, f.base, f.rate, h, f.now);
  find_rates<S>(t, g, f.now, f.rate, h, false);
  add(Real(1));
  move_by<S>(t, f.base, f.sum, Float(t.h * Real(1.0 / 6)), f.now);
}

template <class S>
MW_INLINE void step_of(kernels::Scheme scheme, const Constants& t, const Group& g, Work& w) {
  using kernels::Scheme;
  switch (scheme) {
    case Scheme::explicit_euler: return explicit_euler<S>(t, g, w);
    case Scheme::implicit_euler: return implicit_euler<S>(t, g, w);
    case Scheme::verlet: return verlet<S>(t, g, w);
    case Scheme::velocity_verlet: return velocity_verlet<S>(t, g, w);
    case Scheme::runge_kutta4: return runge_kutta4<S>(t, g, w);
    default: return symplectic_euler<S>(t, g, w);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
