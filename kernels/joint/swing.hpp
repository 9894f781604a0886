// swing: the z axes of two frames are parallel. 2 rows, space only. With b, c across z_A, all of
// the substep:
//   C = (b, c) . (z_A x z_B),  C' = (b, c) . (w_B - w_A),  K = (b, c)^T (I_A^-1 + I_B^-1) (b, c)
#pragma once

#include "kernels/joint/lock.hpp"
#include "kernels/shape/tangent.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct alignas(64) SwingRows : PartBodies<S> {
  Real start_a[3][kLanes], start_b[3][kLanes];  // z axes at the start of the step
  // Of the substep.
  Real across[2][3][kLanes];  // b, c
  Real error[2][kLanes];
  Real mass[3][kLanes];
};

template <class S>
void prepare(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
             SwingRows<S>& s) {
  const Frames<S> f = frames_of<S>(t, g, part, constants);
  store(s.start_a[0], axis_z(f.a)), store(s.start_b[0], axis_z(f.b));
}

template <class S, bool kDense, bool kMoved>
MW_INLINE void refresh(const Work& w, const JointPart& part, const Joint&, SwingRows<S>& s) {
  auto z_a = load_as<Vec3>(s.start_a[0]), z_b = load_as<Vec3>(s.start_b[0]);
  if constexpr (kMoved) {
    z_a = z_a + rotation_of<S>(w, s.body_a).change(z_a);
    z_b = z_b + rotation_of<S>(w, s.body_b).change(z_b);
  }
  const Vec3 b = any_tangent(z_a), c = cross(z_a, b), lean = cross(z_a, z_b);
  store(s.across[0][0], b), store(s.across[1][0], c);
  dot(b, lean).store(s.error[0]), dot(c, lean).store(s.error[1]);
  if (kMoved && part.direct) return;
  const auto inertia = sum_of(inertia_of(s.a), inertia_of(s.b));
  const Vec3 of_b = apply(inertia, b), of_c = apply(inertia, c);
  store(s.mass[0], inverse(Sym2{dot(b, of_b), dot(b, of_c), dot(c, of_c)}));
}

// As curvature_between, of z_A x z_B.
template <class S>
MW_INLINE Vec3 swing_curvature(const Work& w, const SwingRows<S>& s) {
  const Vec3 axis = cross(load_as<Vec3>(s.across[0][0]), load_as<Vec3>(s.across[1][0]));
  return cross(axis, Curvature<S>(w, s.body_b).of(axis) - Curvature<S>(w, s.body_a).of(axis));
}

template <class S, bool kDense, Pass kPass>
MW_INLINE void solve(const Constants&, const Group&, const Work& w, const JointPart& part,
                     const Joint& constants, SwingRows<S>& s, PartVelocities<S, kDense>& v) {
  if constexpr (kPass == Pass::relax) refresh<S, kDense, true>(w, part, constants, s);
  const auto b = load_as<Vec3>(s.across[0][0]), c = load_as<Vec3>(s.across[1][0]),
             stored = load_as<Vec3>(s.impulse[0]);
  const Vec2 before{dot(b, stored), dot(c, stored)};
  if constexpr (kPass == Pass::warm_start) {
    apply_moments<S, kDense>(s, fma(c, before.y, b * before.x), v);
    return;
  }
  const auto mass = load_as<Sym2>(s.mass[0]);
  const Vec3 spin = relative_spin(v.a, v.b);
  Vec2 rate{dot(b, spin), dot(c, spin)}, after;
  if constexpr (kPass == Pass::bias) {
    rate =
        rate + pull_of(load_as<Vec2>(s.error[0]), constants.soft.bias_rate, constants.angular_pull);
    const Float rho = constants.soft.rho, firm = rho + Float(Real(1)),
                scale = Float(Real(1)) / firm;
    if (part.curved) {
      const Vec3 curved = swing_curvature<S>(w, s);
      rate = fma(Vec2{dot(b, curved), dot(c, curved)}, firm, rate);
    }
    after = before - (mul(mass, rate) + before * rho) * scale;
  } else {
    after = before - mul(mass, rate);
  }
  store(s.impulse[0], fma(c, after.y, b * after.x));
  const Vec2 d = after - before;
  apply_moments<S, kDense>(s, fma(c, d.y, b * d.x), v);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
