// The coordinates that rows act along: their values and Jacobians, at the start of the step and in
// every substep.
#pragma once

#include "kernels/joint/drive_and_limits.hpp"

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

MW_INLINE bool is_linear(PartKind kind) {
  return kind == PartKind::slide || kind == PartKind::distance || kind == PartKind::pulley;
}
// A wheel slides along x and rotates about z.
MW_INLINE bool has_other_axis(const JointPart& part) {
  return part.kind == PartKind::slide ? part.turn_hold == TurnHold::swing
                                      : part.point_hold == PointHold::line;
}

template <class S>
void prepare(const Constants& t, const Group& g, const JointPart& part, const Joint& constants,
             Row<S>& s) {
  using Vec = typename S::Vec;
  const Anchors<S> at = anchors_of<S>(t, g, part, constants);
  start_anchors(at, s);
  if (part.kind == PartKind::pulley) {
    const Vec a = place_of<S>(t, g, part.body_a).position + at.arm_a,
              b = place_of<S>(t, g, part.body_b).position + at.arm_b;
    store(s.start_rope_a[0], a - vector_of(S{}, constants.ground_a));
    store(s.start_rope_b[0], b - vector_of(S{}, constants.ground_b));
    return;
  }
  if (part.kind == PartKind::distance) return;
  const Frames<S> f = frames_of<S>(t, g, part, constants);
  const bool slides = part.kind == PartKind::slide;
  if (slides) store(s.start_axis[0], axis_x(f.a));
  if (!slides && has_other_axis(part)) store(s.start_other[0], axis_x(f.a));
  if constexpr (S::kDim == 3) {
    if (!slides) store(s.start_axis[0], axis_z(f.a)), store(s.start_axis_b[0], axis_z(f.b));
    if (slides && has_other_axis(part)) store(s.start_other[0], axis_z(f.a));
  }
  if (!slides && part.kind != PartKind::cone) twist_between(f).store(s.start_value);
}

// Value and Jacobian of a coordinate in m.
template <class S>
MW_INLINE void locate_linear(const JointPart& part, const Joint& constants,
                             const MovedAnchors<S>& now, typename S::Vec axis, Row<S>& s) {
  using Vec = typename S::Vec;
  Vec linear_a, linear_b, arm_a = now.arm_a;
  Float value;
  if (part.kind == PartKind::slide) {
    linear_a = linear_b = axis;
    arm_a = arm_a + now.gap;
    value = dot(axis, now.gap);
  } else if (part.kind == PartKind::distance) {
    linear_a = linear_b = direction_of(now.gap, value);
    store(s.start_rope_a[0], now.arm_a), store(s.start_rope_b[0], now.arm_b);
  } else {
    Float rope_a, rope_b;
    const Float ratio = constants.ratio;
    linear_a = -direction_of(load_as<Vec>(s.start_rope_a[0]) + now.moved_a, rope_a);
    linear_b = direction_of(load_as<Vec>(s.start_rope_b[0]) + now.moved_b, rope_b) * ratio;
    value = fma(rope_b, ratio, rope_a);
  }
  store(s.linear_a[0], linear_a), store(s.linear_b[0], linear_b);
  store(s.angular_a[0], cross(arm_a, linear_a)), store(s.angular_b[0], cross(now.arm_b, linear_b));
  store(s.moment[0], zero_of<typename S::Ang>());
  value.store(s.value);
}
// Of one in rad.
template <class S, bool kDense, bool kMoved>
MW_INLINE void locate_angular(const Work& w, const JointPart& part, Row<S>& s) {
  using Ang = typename S::Ang;
  Ang swept_a = zero_of<Ang>(), swept_b = swept_a, n;
  if constexpr (kMoved) {
    const auto moved = load_sides<S, Free, kDense>(w.displacement, s);
    swept_a = moved.a.w, swept_b = moved.b.w;
  }
  Float value = Float::load(s.start_value);
  if constexpr (S::kDim == 2) {
    if constexpr (kMoved) value = value + (swept_b - swept_a);
    n = Float(Real(1));
  } else {
    auto z_a = load_as<Vec3>(s.start_axis[0]), z_b = load_as<Vec3>(s.start_axis_b[0]);
    if constexpr (kMoved) {
      z_a = z_a + rotation_of<S>(w, s.body_a).change(z_a);
      z_b = z_b + rotation_of<S>(w, s.body_b).change(z_b);
    }
    Float length;
    if (part.kind != PartKind::cone) {
      n = part.kind == PartKind::twist ? twist_axis(z_a, z_b) : direction_of(z_a + z_b, length);
      if constexpr (kMoved) value = value + dot(n, swept_b - swept_a);
    } else {
      const Vec3 lean = cross(z_a, z_b);
      n = direction_of(lean, length);
      n = select(Float(Real(1e-6)) < length, n, any_tangent(z_a));
      value = arc_tangent(length, dot(z_a, z_b));
    }
  }
  store(s.linear_a[0], zero_of<typename S::Vec>()),
      store(s.linear_b[0], zero_of<typename S::Vec>());
  store(s.angular_a[0], n), store(s.angular_b[0], n), store(s.moment[0], n);
  value.store(s.value);
}
template <class S, bool kDense, bool kMoved>
MW_INLINE void locate(const Work& w, const JointPart& part, const Joint& constants, Row<S>& s) {
  if (!is_linear(part.kind)) return locate_angular<S, kDense, kMoved>(w, part, s);
  auto axis = load_as<typename S::Vec>(s.start_axis[0]);
  const MovedAnchors<S> now = anchors_now<S, kDense, kMoved>(w, s, axis);
  locate_linear<S>(part, constants, now, axis, s);
}

template <class S, bool kDense, bool kMoved>
MW_INLINE void refresh(const Work& w, const JointPart& part, const Joint& constants, Row<S>& s) {
  locate<S, kDense, kMoved>(w, part, constants, s);
  if (kMoved && part.direct) return;
  if (!is_held(part)) return weigh_row(s);
  auto other = zero_of<typename S::Vec>();
  if (has_other_axis(part)) other = load_as<typename S::Vec>(s.start_other[0]);
  MovedAnchors<S> now = anchors_now<S, kDense, kMoved>(w, s, other);
  if (part.point_hold == PointHold::point) {
    use_common_point(s, now);
  } else {
    now.arm_a = now.arm_a + now.gap;
  }
  hold_row(part, now.arm_a, now.arm_b, other, s);
}

template <class S, bool kDense, Pass kPass>
MW_INLINE void solve(const Constants& t, const Group& g, const Work& w, const JointPart& part,
                     const Joint& constants, Row<S>& s, PartVelocities<S, kDense>& v) {
  if constexpr (kPass == Pass::relax) refresh<S, kDense, true>(w, part, constants, s);
  solve_placed<S, kDense, kPass>(t, g, w, part, constants, s, v);
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
