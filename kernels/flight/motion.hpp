// A group's motion while an integrator is at it: blocks laid out as the state is, [body][component]
// [lane]. The spin of a body is its angular velocity or, where the plan says so, its angular
// momentum, in world axes.
//
// Planar and Tensor are the spaces here; a plan with scalar inertias is one of tensors with three
// equal moments, whose bodies may have no orientation.
#pragma once

#include "kernels/joint/body.hpp"
#include "kernels/motion/integrate.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Body = kernels::BodyConstants<LaneNumber>;

template <class S>
struct Motion {
  typename S::Vec x, v;
  typename S::Ang spin;
  typename S::Orientation q;
};

MW_INLINE Real* component_of(const Constants& t, Real* block, int body, int component) {
  return block + (body * t.state_stride + component) * kLanes;
}
MW_INLINE const Real* component_of(const Constants& t, const Real* block, int body, int component) {
  return block + (body * t.state_stride + component) * kLanes;
}

MW_INLINE Rot2 no_rotation(Planar) { return {Real(1), Real(0)}; }
MW_INLINE Quat no_rotation(Tensor) { return {Real(1), Real(0), Real(0), Real(0)}; }

template <class S>
MW_INLINE Motion<S> load_motion(const Constants& t, const Real* block, int body) {
  Motion<S> m;
  m.x = load_as<typename S::Vec>(component_of(t, block, body, kState<S>.position));
  m.v = load_as<typename S::Vec>(component_of(t, block, body, kState<S>.linear));
  m.spin = load_as<typename S::Ang>(component_of(t, block, body, kState<S>.angular));
  m.q = no_rotation(S{});
  if (t.has_orientation) {
    m.q = load_as<typename S::Orientation>(component_of(t, block, body, kState<S>.orientation));
  }
  return m;
}
template <class S>
MW_INLINE void store_motion(const Constants& t, Real* block, int body, const Motion<S>& m) {
  store(component_of(t, block, body, kState<S>.position), m.x);
  store(component_of(t, block, body, kState<S>.linear), m.v);
  store(component_of(t, block, body, kState<S>.angular), m.spin);
  if (t.has_orientation) store(component_of(t, block, body, kState<S>.orientation), m.q);
}
inline void copy_motion(const Constants& t, Real* to, const Real* from) {
  const int size = t.bodies * t.state_stride * kLanes;
  for (int i = 0; i < size; i += kLanes) Float::load(from + i).store(to + i);
}

// Inertia, or its inverse, in world axes times a vector.
MW_INLINE Float weigh(const LaneNumber (&moments)[3], Rot2, Float a) { return a * moments[2]; }
MW_INLINE Vec3 weigh(const LaneNumber (&moments)[3], Quat q, Vec3 a) {
  return rotate(q, times(rotate_back(q, a), moments));
}

MW_INLINE bool spins_by_momentum(const Constants& t, int body) {
  return t.flight.momentum && !t.body[body].kinematic;
}
template <class S>
MW_INLINE typename S::Ang angular_velocity(const Constants& t, const Group& g, int body,
                                           const Motion<S>& m) {
  if (!spins_by_momentum(t, body)) return m.spin;
  return weigh(constants_of_body(g, body).inv_inertia, m.q, m.spin);
}

// The same motion with the other kind of spin.
template <class S>
void begin_spins(const Constants& t, const Group& g, Real* block) {
  for (int b = 0; b < t.bodies; ++b) {
    if (!spins_by_momentum(t, b)) continue;
    Motion<S> m = load_motion<S>(t, block, b);
    m.spin = weigh(constants_of_body(g, b).inertia, m.q, m.spin);
    store_motion(t, block, b, m);
  }
}
template <class S>
void end_spins(const Constants& t, const Group& g, Real* block) {
  for (int b = 0; b < t.bodies; ++b) {
    if (!spins_by_momentum(t, b)) continue;
    Motion<S> m = load_motion<S>(t, block, b);
    m.spin = angular_velocity(t, g, b, m);
    store_motion(t, block, b, m);
  }
}

// The rate of an orientation, in a chart about the one that the step began with: the angle in
// the plane; in space a quaternion to add to that one, or a rotation vector.
MW_INLINE Quat half_rotation_rate(Vec3 w, Quat q) {
  const Float half(Real(0.5));
  const Vec3 h = w * half;
  return {-fma(h.z, q.z, fma(h.y, q.y, h.x * q.x)), fms(h.y, q.z, fnma(h.x, q.w, h.z * q.y)),
          fms(h.z, q.x, fnma(h.y, q.w, h.x * q.z)), fms(h.x, q.y, fnma(h.z, q.w, h.y * q.x))};
}
// u' where exp(u(t)) q rotates with w: dexp^-1(u) w, cut after the second commutator, which is
// enough for order 4 (Munthe-Kaas 1998).
MW_INLINE Vec3 chart_rate(Vec3 u, Vec3 w) {
  const Vec3 across = cross(u, w);
  return fma(cross(u, across), Real(1.0 / 12), fnma(across, Real(0.5), w));
}

// Rows of an orientation's rate; `share` of the last rate, if there was one, led to m.
MW_INLINE void store_rotation_rate(const Constants&, Real* rows, Float w, const Motion<Planar>&,
                                   Float, bool) {
  w.store(rows);
}
MW_INLINE void store_rotation_rate(const Constants& t, Real* rows, Vec3 w, const Motion<Tensor>& m,
                                   Float share, bool first) {
  if (t.flight.rotation == kernels::Rotation::quaternion) {
    store(rows, half_rotation_rate(w, m.q));
  } else {
    store(rows, first ? w : chart_rate(load_vec3(rows) * share, w));
  }
}
MW_INLINE Rot2 rotated(const Constants&, Rot2 q, const Real* rows, Float h) {
  return rotate_by(q, Float::load(rows) * h);
}
MW_INLINE Quat rotated(const Constants& t, Quat q, const Real* rows, Float h) {
  if (t.flight.rotation != kernels::Rotation::quaternion) {
    return rotate_by(q, load_vec3(rows) * h);
  }
  const Quat r = load_quat(rows);
  return normalize({fma(h, r.w, q.w), fma(h, r.x, q.x), fma(h, r.y, q.y), fma(h, r.z, q.z)});
}

// The motion h later by these rates.
template <class S>
void move_by(const Constants& t, const Real* from, const Real* rate, Float h, Real* to) {
  for (int b = 0; b < t.bodies; ++b) {
    Motion<S> m = load_motion<S>(t, from, b);
    const auto row = [&](int component) { return component_of(t, rate, b, component); };
    m.x = fma(load_as<typename S::Vec>(row(kState<S>.position)), h, m.x);
    m.v = fma(load_as<typename S::Vec>(row(kState<S>.linear)), h, m.v);
    m.spin = fma(load_as<typename S::Ang>(row(kState<S>.angular)), h, m.spin);
    if (t.has_orientation) m.q = rotated(t, m.q, row(kState<S>.orientation), h);
    store_motion(t, to, b, m);
  }
}

// Velocities and spins after h of their rates.
template <class S>
void change_velocities(const Constants& t, const Real* from, const Real* rate, Float h, Real* to) {
  for (int b = 0; b < t.bodies; ++b) {
    const auto change = [&](auto v, int component) {
      const Real* row = component_of(t, rate, b, component);
      v = fma(load_as<decltype(v)>(row), h,
              load_as<decltype(v)>(component_of(t, from, b, component)));
      store(component_of(t, to, b, component), v);
    };
    change(zero_of<typename S::Vec>(), kState<S>.linear);
    change(zero_of<typename S::Ang>(), kState<S>.angular);
  }
}
// Positions and orientations after h at the velocities.
template <class S>
void go_on(const Constants& t, const Group& g, Real* now, Float h) {
  alignas(64) Real rows[4 * kLanes];
  for (int b = 0; b < t.bodies; ++b) {
    Motion<S> m = load_motion<S>(t, now, b);
    m.x = fma(m.v, h, m.x);
    if (t.has_orientation) {
      store_rotation_rate(t, rows, angular_velocity(t, g, b, m), m, Real(0), true);
      m.q = rotated(t, m.q, rows, h);
    }
    store_motion(t, now, b, m);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
