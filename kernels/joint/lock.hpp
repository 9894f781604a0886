// lock: the frames of two bodies keep the same axes. 1 row in the plane, 3 in space:
//   C = rotation from A's frame to B's (2 sin(angle / 2) about its axis),  C' = w_B - w_A
//   K = I_A^-1 + I_B^-1
#pragma once

#include "kernels/joint/point.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// From frame A to frame B, in the world.
MW_INLINE Float error_between(const Frames<Planar>& f) {
  const Rot2 q = compose(inverse(f.a), f.b);
  return arc_tangent(q.s, q.c);
}
MW_INLINE Vec3 error_of(Quat q) {
  const Float two = copysign(Real(2), q.w);
  return {q.x * two, q.y * two, q.z * two};
}
template <class S>
MW_INLINE Vec3 error_between(const Frames<S>& f) {
  return error_of(compose(f.b, inverse(f.a)));
}

template <class S>
struct alignas(64) LockRows : PartBodies<S> {
  Real start[S::kAng + (S::kDim == 3)][kLanes];  // the rotation when the step began
  // Of the substep.
  Real error[S::kAng][kLanes];
  Real mass[S::kInertia][kLanes];
};

template <class S>
void prepare(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
             LockRows<S>& s) {
  const Frames<S> f = frames_of<S>(t, g, part, constants);
  if constexpr (S::kDim == 2) {
    store(s.start[0], error_between(f));
    store(s.mass[0], inverse(sum_of(inertia_of(s.a), inertia_of(s.b))));
  } else {
    store(s.start[0], compose(f.b, inverse(f.a)));
  }
}

template <class S, bool kDense, bool kMoved>
MW_INLINE void refresh(const Work& w, const JointPart& part, const Joint&, LockRows<S>& s) {
  if constexpr (S::kDim == 2) {
    Float error = Float::load(s.start[0]);
    if constexpr (kMoved) {
      const auto moved = load_sides<S, Free, kDense>(w.displacement, s);
      error = error + relative_spin(moved.a, moved.b);
    }
    store(s.error[0], error);
  } else {
    Quat q = load_quat(s.start[0]);
    if constexpr (kMoved) {
      q = compose(rotation_of<S>(w, s.body_b).q, q);
      q = compose(q, inverse(rotation_of<S>(w, s.body_a).q));
    }
    store(s.error[0], error_of(q));
    if (kMoved && part.direct) return;
    store(s.mass[0], inverse(sum_of(inertia_of(s.a), inertia_of(s.b))));
  }
}

// As curvature_between, of the rotation.
template <class S>
MW_INLINE typename S::Ang lock_curvature(const Work& w, const PartBodies<S>& s) {
  if constexpr (S::kDim == 2) {
    return zero_of<Float>();
  } else {
    return load_vec3(half_change(w, s.body_b)) - load_vec3(half_change(w, s.body_a));
  }
}

template <class S, bool kDense, Pass kPass>
MW_INLINE void solve(const Constants&, const Group&, const Work& w, const JointPart& part,
                     const Joint& constants, LockRows<S>& s, PartVelocities<S, kDense>& v) {
  using Ang = typename S::Ang;
  if constexpr (kPass == Pass::relax) refresh<S, kDense, true>(w, part, constants, s);
  const auto before = load_as<Ang>(s.impulse[0]);
  if constexpr (kPass == Pass::warm_start) {
    apply_moments<S, kDense>(s, before, v);
    return;
  }
  const auto mass = load_as<typename S::Inertia>(s.mass[0]);
  Ang rate = relative_spin(v.a, v.b), after;
  if constexpr (kPass == Pass::bias) {
    rate =
        rate + pull_of(load_as<Ang>(s.error[0]), constants.soft.bias_rate, constants.angular_pull);
    const Float rho = constants.soft.rho, firm = rho + Float(Real(1)),
                scale = Float(Real(1)) / firm;
    if (part.curved) rate = fma(lock_curvature<S>(w, s), firm, rate);
    after = before - (apply(mass, rate) + before * rho) * scale;
  } else {
    after = before - apply(mass, rate);
  }
  store(s.impulse[0], after);
  apply_moments<S, kDense>(s, after - before, v);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
