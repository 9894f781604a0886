// line: B's anchor lies on the x axis of A's frame. 1 row in the plane, 2 in space, along
// directions d across x that are fixed to A. With u from A's anchor to B's:
//   C = d . u,  C' = d . (v_B + w_B x r_B - v_A - w_A x (r_A + u))
#pragma once

#include "kernels/joint/swing.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct alignas(64) LineRows : AnchoredRows<S> {
  static constexpr int kRows = S::kDim - 1;
  Real start_axis[S::kDim][kLanes];
  // Of the substep. arm_a reaches B's anchor.
  Real arm_a[S::kDim][kLanes], arm_b[S::kDim][kLanes];
  Real direction[kRows][S::kDim][kLanes];
  Real error[kRows][kLanes];
  Real mass[3][kLanes];
};

template <class S>
void prepare(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
             LineRows<S>& s) {
  start_anchors(anchors_of<S>(t, g, part, constants), s);
  store(s.start_axis[0], axis_x(frames_of<S>(t, g, part, constants).a));
}

// How a unit impulse along d at both anchors changes the speed along e.
template <class S>
MW_INLINE Float coupling(const PartBodies<S>& s, typename S::Vec arm_a, typename S::Vec arm_b,
                         typename S::Vec d, typename S::Vec e) {
  const Float linear = dot(d, e) * (Float::load(s.a.inv_mass) + Float::load(s.b.inv_mass));
  const Float of_a = dot(cross(arm_a, d), apply(inertia_of(s.a), cross(arm_a, e)));
  const Float of_b = dot(cross(arm_b, d), apply(inertia_of(s.b), cross(arm_b, e)));
  return linear + (of_a + of_b);
}

template <class S, bool kDense, bool kMoved>
MW_INLINE void refresh(const Work& w, const JointPart& part, const Joint&, LineRows<S>& s) {
  using Vec = typename S::Vec;
  auto axis = load_as<Vec>(s.start_axis[0]);
  const MovedAnchors<S> now = anchors_now<S, kDense, kMoved>(w, s, axis);
  const Vec reach = now.arm_a + now.gap, arm_b = now.arm_b, gap = now.gap;
  store(s.arm_a[0], reach), store(s.arm_b[0], arm_b);
  if constexpr (S::kDim == 2) {
    const Vec d{-axis.y, axis.x};
    store(s.direction[0][0], d);
    dot(d, gap).store(s.error[0]);
    if (kMoved && part.direct) return;
    inverse_or_zero(coupling<S>(s, reach, arm_b, d, d)).store(s.mass[0]);
  } else {
    const Vec d = any_tangent(axis), e = cross(axis, d);
    store(s.direction[0][0], d), store(s.direction[1][0], e);
    dot(d, gap).store(s.error[0]), dot(e, gap).store(s.error[1]);
    if (kMoved && part.direct) return;
    store(s.mass[0],
          inverse(Sym2{coupling<S>(s, reach, arm_b, d, d), coupling<S>(s, reach, arm_b, d, e),
                       coupling<S>(s, reach, arm_b, e, e)}));
  }
}

// As curvature_between, of B's anchor against the point of A that is there, which it leaves along
// the axis at `speed` while A rotates: across the axis that adds p x (speed along it).
template <class S>
MW_INLINE typename S::Vec line_curvature(const Work& w, const LineRows<S>& s,
                                         typename S::Vec speed) {
  using Vec = typename S::Vec;
  const Curvature<S> of_a(w, s.body_a), of_b(w, s.body_b);
  const auto d = load_as<Vec>(s.direction[0][0]);
  Vec axis;
  if constexpr (S::kDim == 2) {
    axis = {d.y, -d.x};
  } else {
    axis = cross(d, load_as<Vec>(s.direction[1][0]));
  }
  const Vec curved = of_b.of(load_as<Vec>(s.arm_b[0])) - of_a.of(load_as<Vec>(s.arm_a[0]));
  const Float along = select(curved_lanes(w, s), dot(axis, speed), Real(0));
  return fnma(cross(of_a.angle, axis), along, curved);
}

template <class S, bool kDense, Pass kPass>
MW_INLINE void solve(const Constants&, const Group&, const Work& w, const JointPart& part,
                     const Joint& constants, LineRows<S>& s, PartVelocities<S, kDense>& v) {
  using Vec = typename S::Vec;
  if constexpr (kPass == Pass::relax) refresh<S, kDense, true>(w, part, constants, s);
  const auto arm_a = load_as<Vec>(s.arm_a[0]), arm_b = load_as<Vec>(s.arm_b[0]),
             d = load_as<Vec>(s.direction[0][0]);
  const Float rho = constants.soft.rho, rate = constants.soft.bias_rate;
  const Float firm = rho + Float(Real(1)), scale = Float(Real(1)) / firm;
  if constexpr (S::kDim == 2) {
    const Float before = dot(d, load_as<Vec>(s.impulse[0]));
    if constexpr (kPass == Pass::warm_start) {
      apply_at_anchors<S, kDense>(s, d * before, arm_a, arm_b, v);
      return;
    }
    const Vec speed = anchor_speed<S, kDense>(v, arm_a, arm_b);
    Float x = dot(d, speed);
    const Float mass = Float::load(s.mass[0]);
    if constexpr (kPass == Pass::bias) {
      if (part.curved) x = fma(dot(d, line_curvature<S>(w, s, speed)), firm, x);
      x = fma(mass, x + pull_of(Float::load(s.error[0]), rate, constants.pull), before * rho) *
          scale;
    } else {
      x = mass * x;
    }
    store(s.impulse[0], d * (before - x));
    apply_at_anchors<S, kDense>(s, d * (-x), arm_a, arm_b, v);
  } else {
    const auto e = load_as<Vec>(s.direction[1][0]);
    const auto stored = load_as<Vec>(s.impulse[0]);
    const Vec2 before{dot(d, stored), dot(e, stored)};
    if constexpr (kPass == Pass::warm_start) {
      apply_at_anchors<S, kDense>(s, fma(e, before.y, d * before.x), arm_a, arm_b, v);
      return;
    }
    const Vec speed = anchor_speed<S, kDense>(v, arm_a, arm_b);
    const auto mass = load_as<Sym2>(s.mass[0]);
    Vec2 x{dot(d, speed), dot(e, speed)};
    if constexpr (kPass == Pass::bias) {
      if (part.curved) {
        const Vec curved = line_curvature<S>(w, s, speed);
        x = fma(Vec2{dot(d, curved), dot(e, curved)}, firm, x);
      }
      x = x + pull_of(load_as<Vec2>(s.error[0]), rate, constants.pull);
      x = fma(before, rho, mul(mass, x)) * scale;
    } else {
      x = mul(mass, x);
    }
    const Vec2 after = before - x;
    store(s.impulse[0], fma(e, after.y, d * after.x));
    apply_at_anchors<S, kDense>(s, fma(e, -x.y, d * (-x.x)), arm_a, arm_b, v);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
