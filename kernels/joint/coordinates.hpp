// The coordinates that rows act along: their values and Jacobians, at the start of the step and in
// every substep.
#pragma once

#include "kernels/joint/row.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr double kLeastTwist = 0.01;  // of 1 + z_a . z_b: at a lean of 172 degrees

// v / |v| and |v|; along the last axis where v is all but zero.
MW_INLINE Vec2 direction_of(Vec2 v, Float& length) {
  length = sqrt(dot(v, v));
  const Mask there = Float(Real(1e-12)) < length;
  const Float f = Float(Real(1)) / select(there, length, Real(1)), zero(Real(0));
  return select(there, v * f, {zero, Real(1)});
}
MW_INLINE Vec3 direction_of(Vec3 v, Float& length) {
  length = sqrt(dot(v, v));
  const Mask there = Float(Real(1e-12)) < length;
  const Float f = Float(Real(1)) / select(there, length, Real(1)), zero(Real(0));
  return select(there, v * f, {zero, zero, Real(1)});
}

// Twist about z that takes A's frame to B's.
MW_INLINE Float twist_between(const Frames<Planar>& f) { return error_between(f); }
template <class S>
MW_INLINE Float twist_between(const Frames<S>& f) {
  const Quat q = compose(inverse(f.a), f.b);
  const Float half = arc_tangent(copysign(Real(1), q.w) * q.z, abs(q.w));
  return half + half;
}

// The twist changes by that times the relative angular velocity: (z_a + z_b) / (1 + z_a . z_b), by
// the derivative of twist_between. Against one another the axes have no twist.
MW_INLINE Vec3 twist_axis(Vec3 z_a, Vec3 z_b) {
  const Float one(Real(1));
  return (z_a + z_b) * (one / max(one + dot(z_a, z_b), Real(kLeastTwist)));
}

template <class S>
void prepare(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
             Row<S, true>& s) {
  using Vec = typename S::Vec;
  const Anchors<S> at = anchors_of<S>(t, g, part, constants);
  start_anchors(at, s);
  if (part.kind == PartKind::slide) {
    store(s.start_axis[0], axis_x(frames_of<S>(t, g, part, constants).a));
  } else if (part.kind == PartKind::pulley) {
    const Vec a = place_of<S>(t, g, part.body_a).position + at.arm_a,
              b = place_of<S>(t, g, part.body_b).position + at.arm_b;
    store(s.start_rope_a[0], a - vector_of(S{}, constants.ground_a));
    store(s.start_rope_b[0], b - vector_of(S{}, constants.ground_b));
  }
}

template <class S>
void prepare(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
             Row<S, false>& s) {
  const Frames<S> f = frames_of<S>(t, g, part, constants);
  if constexpr (S::kDim == 3) {
    store(s.start_axis[0], axis_z(f.a)), store(s.start_axis_b[0], axis_z(f.b));
  }
  if (part.kind != PartKind::cone) twist_between(f).store(s.start_value);
}

template <class S, bool kDense, bool kMoved>
MW_INLINE void locate(const Work& w, const JointPart& part, const Joint& constants,
                      Row<S, true>& s) {
  using Vec = typename S::Vec;
  auto axis = load_as<Vec>(s.start_axis[0]);
  MovedAnchors<S> now = anchors_now<S, kDense, kMoved>(w, s, axis);
  Vec linear_a, linear_b;
  Float value;
  if (part.kind == PartKind::slide) {
    linear_a = linear_b = axis;
    now.arm_a = now.arm_a + now.gap;
    value = dot(axis, now.gap);
  } else if (part.kind == PartKind::distance) {
    linear_a = linear_b = direction_of(now.gap, value);
  } else {
    Float rope_a, rope_b;
    const Float ratio = constants.ratio;
    linear_a = -direction_of(load_as<Vec>(s.start_rope_a[0]) + now.moved_a, rope_a);
    linear_b = direction_of(load_as<Vec>(s.start_rope_b[0]) + now.moved_b, rope_b) * ratio;
    value = fma(rope_b, ratio, rope_a);
  }
  store(s.linear_a[0], linear_a), store(s.linear_b[0], linear_b);
  store(s.angular_a[0], cross(now.arm_a, linear_a)),
      store(s.angular_b[0], cross(now.arm_b, linear_b));
  value.store(s.value);
}

template <class S, bool kDense, bool kMoved>
MW_INLINE void locate(const Work& w, const JointPart& part, const Joint&, Row<S, false>& s) {
  using Ang = typename S::Ang;
  Ang swept_a = zero_of<Ang>(), swept_b = swept_a;
  if constexpr (kMoved) {
    const auto moved = load_sides<S, Free, kDense>(w.displacement, s);
    swept_a = moved.a.w, swept_b = moved.b.w;
  }
  if constexpr (S::kDim == 2) {
    const Float one(Real(1)), value = Float::load(s.start_value);
    (kMoved ? value + (swept_b - swept_a) : value).store(s.value);
    one.store(s.angular_a[0]), one.store(s.angular_b[0]);
  } else {
    auto z_a = load_as<Vec3>(s.start_axis[0]), z_b = load_as<Vec3>(s.start_axis_b[0]);
    if constexpr (kMoved) {
      z_a = z_a + SweptRotation<S>(w, s.body_a).change(z_a);
      z_b = z_b + SweptRotation<S>(w, s.body_b).change(z_b);
    }
    Vec3 n;
    Float value = Float::load(s.start_value), length;
    if (part.kind != PartKind::cone) {
      n = part.kind == PartKind::twist ? twist_axis(z_a, z_b) : direction_of(z_a + z_b, length);
      if constexpr (kMoved) value = value + dot(n, swept_b - swept_a);
    } else {
      const Vec3 lean = cross(z_a, z_b);
      n = direction_of(lean, length);
      n = select(Float(Real(1e-6)) < length, n, any_tangent(z_a));
      value = arc_tangent(length, dot(z_a, z_b));
    }
    store(s.angular_a[0], n), store(s.angular_b[0], n);
    value.store(s.value);
  }
}

template <class S, bool kDense, bool kMoved, bool kLinear>
MW_INLINE void refresh(const Work& w, const JointPart& part, const Joint& constants,
                       Row<S, kLinear>& s) {
  locate<S, kDense, kMoved>(w, part, constants, s);
  weigh_row(s);
}

template <class S, bool kDense, Pass kPass, bool kLinear>
MW_INLINE void solve(const Constants& t, const Group& g, const Work& w, const JointPart& part,
                     const Joint& constants, Row<S, kLinear>& s, PartVelocities<S, kDense>& v) {
  if constexpr (kPass == Pass::relax) refresh<S, kDense, true>(w, part, constants, s);
  solve_row<S, kLinear, kDense, kPass>(t, g, part, constants, s, v);
}

// Of both sides of a joint in the state; the world is still.
template <class S>
struct TwoBodies {
  Velocity<S> a, b;
};
template <class S>
MW_INLINE Velocity<S> velocity_of(const Constants& t, const Group& g, int body) {
  if (body == t.bodies) return {zero_of<typename S::Vec>(), zero_of<typename S::Ang>()};
  return {load_as<typename S::Vec>(state_of(t, g, body, kState<S>.linear)),
          load_as<typename S::Ang>(state_of(t, g, body, kState<S>.angular))};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
