// Work that drives, springs, springy limits and joints that close gradually do in a step, for the
// audit of energy. Impulses and velocities are linear in each other: a row whose impulse in a
// substep is p, and whose speed goes from s to s', has given p (s + s') / 2.
#pragma once

#include "kernels/joint/coordinates.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Impulse of the rows of a part that may give energy, and their speed.
template <class S>
struct Driven {
  Float impulse[S::kDim], speed[S::kDim];
  int rows = 0;
};
template <class S, class Velocities>
MW_INLINE Driven<S> driven(const JointPart& part, const Row<S>& s, const Velocities& v) {
  Driven<S> out;
  out.rows = 1;
  out.speed[0] = speed_of(s, v);
  out.impulse[0] = Float(Real(0));
  if (part.drive) out.impulse[0] = Float::load(s.impulse[0]);
  if (part.soft_limit) {
    out.impulse[0] = out.impulse[0] + (Float::load(s.impulse[1]) - Float::load(s.impulse[2]));
  }
  return out;
}
template <class S, class Rows, class Velocities>
MW_INLINE Driven<S> driven_at_anchors(const Rows& s, const Velocities& v) {
  using Vec = typename S::Vec;
  Driven<S> out;
  out.rows = S::kDim;
  const Vec speed = v.b.v + cross(v.b.w, load_as<Vec>(s.arm_b[0])) -
                    (v.a.v + cross(v.a.w, load_as<Vec>(s.arm_a[0])));
  alignas(64) Real number[S::kDim][kLanes];
  store(number[0], speed);
  for (int i = 0; i < S::kDim; ++i) {
    out.speed[i] = Float::load(number[i]), out.impulse[i] = Float::load(s.impulse[i]);
  }
  return out;
}
template <class S, class Velocities>
MW_INLINE Driven<S> driven(const JointPart&, const PointRows<S>& s, const Velocities& v) {
  return driven_at_anchors<S>(s, v);
}
template <class S, class Velocities>
MW_INLINE Driven<S> driven(const JointPart&, const LineRows<S>& s, const Velocities& v) {
  return driven_at_anchors<S>(s, v);
}
template <class S, class Velocities>
MW_INLINE Driven<S> driven(const JointPart&, const PartBodies<S>&, const Velocities&) {
  return {};
}

// Adds what the rows `s` of a part have given in this substep.
template <class S, bool kDense, class Rows>
MW_INLINE void add_drive_work(const Constants& t, const Group& g, const Work& w,
                              const JointPart& part, int index, const Rows& s) {
  if (!gives_energy(part) || s.mask == 0) return;
  const Driven<S> now = driven<S>(part, s, PartVelocities<S, kDense>(w, s));
  Real* kept = w.audit.speed + index * 3 * kLanes;
  if (w.substep == 0) {
    const TwoBodies<S> v{velocity_of<S>(t, g, part.body_a), velocity_of<S>(t, g, part.body_b)};
    const Driven<S> start = driven<S>(part, s, v);
    for (int i = 0; i < start.rows; ++i) start.speed[i].store(kept + i * kLanes);
  }
  const Float half(Real(0.5)), zero(Real(0));
  Float work = zero;
  for (int i = 0; i < now.rows; ++i) {
    Real* last = kept + i * kLanes;
    work = fma(now.impulse[i] * half, Float::load(last) + now.speed[i], work);
    now.speed[i].store(last);
  }
  add_to(w.audit.sums, kDriven, select(mask_from_bits(s.mask), work, zero));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
