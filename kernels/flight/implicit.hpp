// Implicit Euler of a group: velocities u' at the end of h from one linear system,
//   (M (1 + h c) + sum of J^T D J over springs) u' = M u + h f,   D = h c_spring + h^2 k
// with f the forces at the start, J u the speed of a spring's anchors, M masses and inertias in
// world axes (Baraff, Witkin 1998). Of the stiffness across a spring only what pulls counts, so
// that the matrix is positive definite. The gyroscopic term comes first, body by body, by a Newton
// step of its own. The system is solved by conjugate gradients that M preconditions; each lane
// stops by itself.
#pragma once

#include "kernels/flight/forces.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Square of the share of the first residual at which a lane is done.
inline constexpr Real kResidual2 = sizeof(Real) == 4 ? Real(1e-12) : Real(1e-26);
// Of the residual itself: what is below counts as none.
inline constexpr Real kNoResidual2 = sizeof(Real) == 4 ? Real(1e-30) : Real(1e-280);

template <class S>
MW_INLINE Velocity<S> load_rates(const Constants& t, const Real* block, int body) {
  return {load_as<typename S::Vec>(component_of(t, block, body, kState<S>.linear)),
          load_as<typename S::Ang>(component_of(t, block, body, kState<S>.angular))};
}
template <class S>
MW_INLINE void store_rates(const Constants& t, Real* block, int body, const Velocity<S>& u) {
  store(component_of(t, block, body, kState<S>.linear), u.v);
  store(component_of(t, block, body, kState<S>.angular), u.w);
}
template <class S>
MW_INLINE Velocity<S> no_rates() {
  return {zero_of<typename S::Vec>(), zero_of<typename S::Ang>()};
}
template <class S>
MW_INLINE Velocity<S> add_scaled(const Velocity<S>& a, Float s, const Velocity<S>& b) {
  return {fma(a.v, s, b.v), fma(a.w, s, b.w)};
}
template <class S>
MW_INLINE Float dot(const Velocity<S>& a, const Velocity<S>& b) {
  return dot(a.v, b.v) + dot(a.w, b.w);
}

// (1 + h drag) M u of a dynamic body, or its inverse.
template <class S>
MW_INLINE Velocity<S> times_mass(const Constants& t, const Body& n, const Motion<S>& m,
                                 const Velocity<S>& u) {
  const Float h(t.h), one(Real(1)), mass = one / Float(n.inv_mass);
  return {u.v * (mass * fma(h, n.linear_drag, one)),
          weigh(n.inertia, m.q, u.w) * fma(h, n.angular_drag, one)};
}
template <class S>
MW_INLINE Velocity<S> over_mass(const Constants& t, const Body& n, const Motion<S>& m,
                                const Velocity<S>& p) {
  const Float h(t.h), one(Real(1));
  return {p.v * (Float(n.inv_mass) / fma(h, n.linear_drag, one)),
          weigh(n.inv_inertia, m.q, p.w) * (one / fma(h, n.angular_drag, one))};
}

template <class S>
MW_INLINE void add_to_body(const Constants& t, Real* block, int body, typename S::Vec p,
                           typename S::Vec arm) {
  if (body == t.bodies || t.body[body].kinematic) return;
  const Velocity<S> before = load_rates<S>(t, block, body);
  store_rates<S>(t, block, body, {before.v + p, before.w + cross(arm, p)});
}
template <class S>
MW_INLINE typename S::Vec speed_at(const Constants& t, const Real* block, int body,
                                   typename S::Vec arm) {
  if (body == t.bodies) return zero_of<typename S::Vec>();
  const Velocity<S> u = load_rates<S>(t, block, body);
  return u.v + cross(u.w, arm);
}

// Rows of a body where it takes part, 0 where it is disabled or asleep.
template <class S>
MW_INLINE Velocity<S> of_present(const Group& g, int body, const Velocity<S>& rows) {
  if (!has_idle_bodies(g)) return rows;
  return select(mask_from_bits(~idle_lanes(g, body) & kAllLanes), rows, no_rates<S>());
}

// The matrix times `in`; rows of kinematic bodies are 0.
template <class S>
void times_matrix(const Constants& t, const Group& g, const Real* now, const Real* in, Real* out) {
  for (int b = 0; b < t.bodies; ++b) {
    Velocity<S> p = no_rates<S>();
    if (!t.body[b].kinematic) {
      p = of_present(g, b,
                     times_mass<S>(t, constants_of_body(g, b), load_motion<S>(t, now, b),
                                   load_rates<S>(t, in, b)));
    }
    store_rates<S>(t, out, b, p);
  }
  const Float h(t.h), zero(Real(0)), one(Real(1));
  for_each_spring(t, g, [&](const JointPart& part, const Joint& constants, int) {
    const SpringNow<S> s = spring_now<S>(t, g, part, constants, now);
    const auto speed =
        speed_at<S>(t, in, part.body_b, s.arm_b) - speed_at<S>(t, in, part.body_a, s.arm_a);
    const Float k = Float(constants.stiffness) * (h * h), along = fma(h, constants.damping, k);
    auto p = speed * along;
    if (part.kind != PartKind::point) {
      const Float slack = one - Float(constants.target_position) / max(s.length, Real(1e-12));
      const Float across = k * max(slack, zero);
      p = fma(s.along, dot(s.along, speed) * (along - across), speed * across);
    }
    p = select(s.active, p, zero_of<typename S::Vec>());
    add_to_body<S>(t, out, part.body_b, p, s.arm_b);
    add_to_body<S>(t, out, part.body_a, -p, s.arm_a);
  });
}

// Conjugate gradients for the velocities in f.now; f.rate holds M u + h f.
template <class S>
void solve_velocities(const Constants& t, const Group& g, FlightWork& f) {
  const auto for_each_dynamic = [&](auto visit) {
    for (int b = 0; b < t.bodies; ++b) {
      if (!t.body[b].kinematic) visit(b);
    }
  };
  const auto preconditioned = [&](int b) {
    return of_present(g, b,
                      over_mass<S>(t, constants_of_body(g, b), load_motion<S>(t, f.now, b),
                                   load_rates<S>(t, f.rate, b)));
  };
  Float old(Real(0));  // residual times preconditioned residual
  times_matrix<S>(t, g, f.now, f.now, f.base);
  for (int b = 0; b < t.bodies; ++b) store_rates<S>(t, f.sum, b, no_rates<S>());
  for_each_dynamic([&](int b) {
    const Float minus(Real(-1));
    const Velocity<S> r =
        add_scaled<S>(load_rates<S>(t, f.base, b), minus, load_rates<S>(t, f.rate, b));
    store_rates<S>(t, f.rate, b, of_present(g, b, r));
    const Velocity<S> z = preconditioned(b);
    store_rates<S>(t, f.sum, b, z);
    old = old + dot(z, load_rates<S>(t, f.rate, b));
  });
  const Float enough = old * Float(kResidual2);
  // What is not a number takes a step, too, so that finish finds it in the velocities.
  Mask running = !(old <= Float(kNoResidual2));
  const int most = (S::kDim + S::kAng) * t.bodies + 10;
  for (int i = 0; i < most && any(running); ++i) {
    times_matrix<S>(t, g, f.now, f.sum, f.base);
    Float bent(Real(0)), fresh(Real(0));
    for_each_dynamic(
        [&](int b) { bent = bent + dot(load_rates<S>(t, f.sum, b), load_rates<S>(t, f.base, b)); });
    const Float step = old / bent;
    for_each_dynamic([&](int b) {
      const Velocity<S> u = load_rates<S>(t, f.now, b);
      store_rates<S>(t, f.now, b,
                     select(running, add_scaled<S>(load_rates<S>(t, f.sum, b), step, u), u));
      store_rates<S>(
          t, f.rate, b,
          add_scaled<S>(load_rates<S>(t, f.base, b), -step, load_rates<S>(t, f.rate, b)));
      fresh = fresh + dot(preconditioned(b), load_rates<S>(t, f.rate, b));
    });
    const Float again = fresh / old;
    for_each_dynamic([&](int b) {
      store_rates<S>(t, f.sum, b,
                     add_scaled<S>(load_rates<S>(t, f.sum, b), again, preconditioned(b)));
    });
    running = running & (enough < fresh);
    old = fresh;
  }
}

template <class S>
void implicit_euler(const Constants& t, const Group& g, Work& w) {
  FlightWork& f = w.flight;
  gather_forces<S, false>(t, g, f.now, f.rate);
  const Float h(t.h);
  for (int b = 0; b < t.bodies; ++b) {
    if (t.body[b].kinematic) continue;
    const Body& constants = constants_of_body(g, b);
    Motion<S> m = load_motion<S>(t, f.now, b);
    if constexpr (S::kDim == 3) {
      m.spin = implicit_gyroscopic(t.h, relative_moments(constants), matrix(m.q), m.spin);
    }
    const Velocity<S> forced = load_rates<S>(t, f.rate, b);
    const Float mass = Float(Real(1)) / Float(constants.inv_mass);
    const Velocity<S> p{fma(forced.v, h, m.v) * mass,
                        fma(forced.w, h, weigh(constants.inertia, m.q, m.spin))};
    store_rates<S>(t, f.rate, b, p);
    if (t.flight.springs == 0) {
      const Velocity<S> u = over_mass<S>(t, constants, m, p);
      m.v = u.v, m.spin = u.w;
    }
    store_motion(t, f.now, b, m);
  }
  if (t.flight.springs > 0) solve_velocities<S>(t, g, f);
  go_on<S>(t, g, f.now, h);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
