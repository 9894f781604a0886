// lock: the frames of two bodies keep the same axes. 1 row in the plane, 3 in space:
//   C = rotation from A's frame to B's (2 sin(angle / 2) about its axis),  C' = w_B - w_A
//   K = I_A^-1 + I_B^-1
#pragma once

#include "kernels/joint/point.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

MW_INLINE Float sum_of(Float a, Float b) { return a + b; }
MW_INLINE Sym3 sum_of(const Sym3& a, const Sym3& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.xz + b.xz, a.yy + b.yy, a.yz + b.yz, a.zz + b.zz};
}
MW_INLINE Float inverse(Float a) { return inverse_or_zero(a); }

// From frame A to frame B, in the world.
MW_INLINE Float error_between(const Frames<Planar>& f) {
  const Rot2 q = compose(inverse(f.a), f.b);
  return arc_tangent(q.s, q.c);
}
template <class S>
MW_INLINE Vec3 error_between(const Frames<S>& f) {
  const Quat q = compose(f.b, inverse(f.a));
  const Float two = copysign(Real(2), q.w);
  return {q.x * two, q.y * two, q.z * two};
}

template <class S>
struct alignas(64) LockRows : PartBodies<S> {
  Real error[S::kAng][kLanes];  // at the start of the step
  Real mass[S::kInertia][kLanes];
};

template <class S>
void prepare(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
             LockRows<S>& s) {
  store(s.error[0], error_between(frames_of<S>(t, g, part, constants)));
  store(s.mass[0], inverse(sum_of(inertia_of(s.a), inertia_of(s.b))));
}

// Its Jacobian stays what it is.
template <class S, bool kDense, bool kMoved>
MW_INLINE void refresh(const Work&, const JointPart&, const Joint&, LockRows<S>&) {}

template <class S, bool kDense, Pass kPass>
MW_INLINE void solve(const Constants&, const Group&, const Work& w, const JointPart&,
                     const Joint& constants, LockRows<S>& s, PartVelocities<S, kDense>& v) {
  using Ang = typename S::Ang;
  const auto before = load_as<Ang>(s.impulse[0]);
  if constexpr (kPass == Pass::warm_start) {
    apply_moments<S, kDense>(s, before, v);
    return;
  }
  const auto mass = load_as<typename S::Inertia>(s.mass[0]);
  Ang rate = relative_spin(v.a, v.b), after;
  if constexpr (kPass == Pass::bias) {
    const auto moved = load_sides<S, Free, kDense>(w.displacement, s);
    const Ang error = load_as<Ang>(s.error[0]) + relative_spin(moved.a, moved.b);
    rate = rate + pull_of(error, constants.soft.bias_rate, constants.angular_pull);
    const Float rho = constants.soft.rho, scale = Float(Real(1)) / (rho + Float(Real(1)));
    after = before - (apply(mass, rate) + before * rho) * scale;
  } else {
    after = before - apply(mass, rate);
  }
  store(s.impulse[0], after);
  apply_moments<S, kDense>(s, after - before, v);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
