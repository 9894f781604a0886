// A single row of a joint along a coordinate x with speed v = J (velocities): held at a value,
// driven, limited, or some of these. Its Jacobian is [-linear_a, -angular_a, linear_b, angular_b],
// K = J M^-1 J^T. What holds the two bodies otherwise is part of it (held_row.hpp).
//   held     C = x - rest, soft in the bias pass
//   driven and limited: drive_and_limits.hpp
#pragma once

#include "kernels/joint/line.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct alignas(64) Row : AnchoredRows<S> {
  // At the start of the step. Axes: x of A for a slide, else z of A, and z of B; the one of A about
  // which a wheel's slide turns, or along which it slides where the row is its rotation.
  Real start_axis[3][kLanes], start_axis_b[3][kLanes], start_other[3][kLanes];
  // Of a pulley; of a distance its arms in the substep.
  Real start_rope_a[S::kDim][kLanes], start_rope_b[S::kDim][kLanes];
  Real start_value[kLanes];
  // Of the substep.
  Real linear_a[S::kDim][kLanes], linear_b[S::kDim][kLanes];
  Real angular_a[S::kAng][kLanes], angular_b[S::kAng][kLanes];
  Real moment[S::kAng][kLanes];  // what a unit impulse gives B beside the force at its anchor
  // Its share that the joint's other parts apply (held_row.hpp).
  Real reaction_force[S::kDim][kLanes], reaction_moment[S::kAng][kLanes];
  Real value[kLanes];
  Real driven[kLanes];  // the value of the bias pass
  Real k[kLanes];
  Real free_k[kLanes];  // of a row that nothing holds: K of free bodies, whatever trees they are of
};
// By which springs of a frequency are as stiff as if their bodies were free.
template <class S>
MW_INLINE Float k_of_springs(const JointPart& part, const Row<S>& s) {
  return Float::load(part.attached ? s.free_k : s.k);
}

template <class S, class Velocities>
MW_INLINE Float speed_of(const Row<S>& s, const Velocities& v) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const Float angular =
      dot(load_as<Ang>(s.angular_b[0]), v.b.w) - dot(load_as<Ang>(s.angular_a[0]), v.a.w);
  return angular +
         (dot(load_as<Vec>(s.linear_b[0]), v.b.v) - dot(load_as<Vec>(s.linear_a[0]), v.a.v));
}
template <class S, bool kDense>
MW_INLINE void apply_row(const Row<S>& s, Float p, PartVelocities<S, kDense>& v) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const Ang a = load_as<Ang>(s.angular_a[0]) * p, b = load_as<Ang>(s.angular_b[0]) * p;
  add_impulse(s.b, load_as<Vec>(s.linear_b[0]), p, b, v.b);
  take_impulse(s.a, load_as<Vec>(s.linear_a[0]), p, a, v.a);
}
template <class S>
MW_INLINE void weigh_row(Row<S>& s) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const Ang a = load_as<Ang>(s.angular_a[0]), b = load_as<Ang>(s.angular_b[0]);
  const Vec linear_a = load_as<Vec>(s.linear_a[0]), linear_b = load_as<Vec>(s.linear_b[0]);
  const Float of_spin = dot(a, apply(inertia_of(s.a), a)) + dot(b, apply(inertia_of(s.b), b));
  const Float of_b = dot(linear_b, linear_b) * Float::load(s.b.inv_mass);
  const Float k = of_spin + fma(dot(linear_a, linear_a), Float::load(s.a.inv_mass), of_b);
  k.store(s.k), k.store(s.free_k);
}

// lambda' - lambda of a soft row that is to have a speed of 0, before any clamp.
MW_INLINE Float soften_row(const kernels::RowSoftness<LaneNumber>& soft, Float k, Float speed,
                           Float before) {
  const Float softer = fma(k, soft.rho, k) + Float(soft.gamma);
  return -(fma(softer - k, before, speed) * inverse_or_zero(softer));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
