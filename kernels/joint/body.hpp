// The bodies of a part: their masses, where they were when the step began, and how far the substeps
// have moved them since.
#pragma once

#include "kernels/lane/solve.hpp"
#include "kernels/motion/substep_rotation.hpp"
#include "kernels/rows/velocities.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Joint = kernels::JointConstants<LaneNumber>;
using kernels::JointPart, kernels::PartKind;

MW_INLINE const Joint& constants_of_part(const Group& g, int part) {
  return reinterpret_cast<const Joint*>(g.constants.joint)[part];
}

// A body of a joint, which in space shares its inertia with all its joints: the substeps rotate it.
struct Jointed {};
template <>
struct SideRows<Planar, Jointed> : SideRows<Planar, Free> {};
template <>
struct alignas(64) SideRows<Tensor, Jointed> {
  Real inv_mass[kLanes];
  const Real* inertia;  // inverse; rows of Work::rotation
};
MW_INLINE Float inertia_of(const SideRows<Planar, Jointed>& side) {
  return Float::load(side.inertia[0]);
}
MW_INLINE Sym3 inertia_of(const SideRows<Tensor, Jointed>& side) {
  return load_as<Sym3>(side.inertia);
}

// What all parts have. The world is a body that has no velocity and infinite mass.
template <class S>
struct alignas(64) PartBodies : RowBodies {
  SideRows<S, Jointed> a, b;
  Real impulse[kernels::kPartImpulses][kLanes];
};

template <class S, bool kDense>
using PartVelocities = RowVelocities<S, Free, kDense>;

MW_INLINE Vec3 axis_x(Quat q) {
  const Float y2 = q.y + q.y, z2 = q.z + q.z;
  return {fnma(q.z, z2, fnma(q.y, y2, Real(1))), fma(q.x, y2, q.w * z2), fms(q.x, z2, q.w * y2)};
}
MW_INLINE Vec3 axis_z(Quat q) {
  const Float x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  return {fma(q.x, z2, q.w * y2), fms(q.y, z2, q.w * x2), fnma(q.y, y2, fnma(q.x, x2, Real(1)))};
}
MW_INLINE Vec2 axis_x(Rot2 q) { return {q.c, q.s}; }

template <class S>
MW_INLINE void put_body(const Constants& t, const Group& g, const Work& w, int body,
                        SideRows<S, Jointed>& side) {
  const Float zero(Real(0));
  const bool moves = body < t.bodies;
  (moves ? Float(constants_of_body(g, body).inv_mass) : zero).store(side.inv_mass);
  if constexpr (S::kDim == 3) {
    side.inertia = rotated_inertia(w, body);
  } else {
    (moves ? Float(constants_of_body(g, body).inv_inertia[2]) : zero).store(side.inertia[0]);
  }
}

MW_INLINE Vec2 vector_of(Planar, const LaneNumber* v) { return {v[0], v[1]}; }
template <class S>
MW_INLINE Vec3 vector_of(S, const LaneNumber* v) {
  return {v[0], v[1], v[2]};
}
MW_INLINE Rot2 frame_of(Planar, const LaneNumber* q) { return {q[0], q[1]}; }
template <class S>
MW_INLINE Quat frame_of(S, const LaneNumber* q) {
  return {q[0], q[1], q[2], q[3]};
}

MW_INLINE Rot2 inverse(Rot2 q) { return {q.c, -q.s}; }
MW_INLINE Quat inverse(Quat q) { return {q.w, -q.x, -q.y, -q.z}; }

template <class S>
struct Place {
  typename S::Vec position;
  typename S::Orientation orientation;
};
template <class S>
MW_INLINE Place<S> place_of(const Constants& t, const Group& g, int body) {
  return {load_as<typename S::Vec>(state_of(t, g, body, kState<S>.position)),
          load_as<typename S::Orientation>(state_of(t, g, body, kState<S>.orientation))};
}

// Anchors from the centres of mass, and how far B's lies from A's. A part on the world has its
// anchor and its frame there.
template <class S>
struct Anchors {
  typename S::Vec arm_a, arm_b, gap;
};
template <class S>
MW_INLINE Anchors<S> anchors_of(const Constants& t, const Group& g, const JointPart& part,
                                const Joint& constants) {
  Anchors<S> out;
  const Place<S> b = place_of<S>(t, g, part.body_b);
  out.arm_b = rotate(b.orientation, vector_of(S{}, constants.anchor_b));
  const auto anchor_a = vector_of(S{}, constants.anchor_a);
  if (part.body_a == t.bodies) {
    out.arm_a = zero_of<typename S::Vec>();
    out.gap = (b.position - anchor_a) + out.arm_b;
  } else {
    const Place<S> a = place_of<S>(t, g, part.body_a);
    out.arm_a = rotate(a.orientation, anchor_a);
    out.gap = (b.position - a.position) + (out.arm_b - out.arm_a);
  }
  return out;
}
template <class S>
struct Frames {
  typename S::Orientation a, b;  // in the world
};
template <class S>
MW_INLINE Frames<S> frames_of(const Constants& t, const Group& g, const JointPart& part,
                              const Joint& constants) {
  Frames<S> out;
  out.b = compose(place_of<S>(t, g, part.body_b).orientation, frame_of(S{}, constants.frame_b));
  out.a = frame_of(S{}, constants.frame_a);
  if (part.body_a != t.bodies) {
    out.a = compose(place_of<S>(t, g, part.body_a).orientation, out.a);
  }
  return out;
}

// Rows between two anchors: from the centres, and their gap, when the step began.
template <class S>
struct alignas(64) AnchoredRows : PartBodies<S> {
  Real start_a[S::kDim][kLanes], start_b[S::kDim][kLanes], start_gap[S::kDim][kLanes];
};
template <class S>
MW_INLINE void start_anchors(const Anchors<S>& at, AnchoredRows<S>& s) {
  store(s.start_a[0], at.arm_a), store(s.start_b[0], at.arm_b), store(s.start_gap[0], at.gap);
}

// Where the substeps have taken the anchors.
template <class S>
struct MovedAnchors : Anchors<S> {
  typename S::Vec moved_a, moved_b;  // since the step began
};
// kMoved: the substeps have displaced the bodies. `axis` is fixed to A.
template <class S, bool kDense, bool kMoved>
MW_INLINE MovedAnchors<S> anchors_now(const Work& w, const AnchoredRows<S>& s,
                                      typename S::Vec& axis) {
  using Vec = typename S::Vec;
  MovedAnchors<S> out;
  out.arm_a = load_as<Vec>(s.start_a[0]), out.arm_b = load_as<Vec>(s.start_b[0]);
  out.gap = load_as<Vec>(s.start_gap[0]);
  out.moved_a = out.moved_b = zero_of<Vec>();
  if constexpr (kMoved) {
    const auto moved = load_sides<S, Free, kDense>(w.displacement, s);
    const Rotation<S> of_a = rotation_of<S>(w, s.body_a), of_b = rotation_of<S>(w, s.body_b);
    const Vec change_a = of_a.change(out.arm_a), change_b = of_b.change(out.arm_b);
    out.arm_a = out.arm_a + change_a, out.arm_b = out.arm_b + change_b;
    out.moved_a = moved.a.v + change_a, out.moved_b = moved.b.v + change_b;
    out.gap = out.gap + (out.moved_b - out.moved_a);
    axis = axis + of_a.change(axis);
  }
  return out;
}
template <class S, bool kDense, bool kMoved>
MW_INLINE MovedAnchors<S> anchors_now(const Work& w, const AnchoredRows<S>& s) {
  auto none = zero_of<typename S::Vec>();
  return anchors_now<S, kDense, kMoved>(w, s, none);
}

// Both arms to one point between the anchors: two forces that are apart would be a moment on the
// pair. The nearer to the anchor of the lighter body, so that what hangs on the world is pulled
// where it is held, and in the same way whichever body is A.
template <class S>
MW_INLINE void use_common_point(const PartBodies<S>& s, MovedAnchors<S>& at) {
  const Float a = Float::load(s.a.inv_mass),
              share = a * inverse_or_zero(a + Float::load(s.b.inv_mass));
  const auto of_b = at.gap * share;
  at.arm_a = at.arm_a + (at.gap - of_b), at.arm_b = at.arm_b - of_b;
}

// The speed at which an error is corrected, capped by length: what is far apart closes steadily.
MW_INLINE Float pull_of(Float error, Float rate, Float cap) {
  return clamp(error * rate, -cap, cap);
}
template <class V>
MW_INLINE V pull_of(V error, Float rate, Float cap) {
  const V pull = error * rate;
  const Float square = dot(pull, pull);
  if (all(surely_within(square, cap))) return pull;  // what else is the same, and takes long
  return pull * (cap / max(sqrt(square), cap));
}
// Of a joint that begins apart by less than `slack`: what opens beyond that closes as fast as ever.
template <class V>
MW_INLINE V pull_of(V error, Float rate, Float cap, Float slack) {
  return pull_of(error, rate, max(cap, fnma(slack, rate, length_of(error) * rate)));
}

// Applies an impulse to B at its anchor, and the opposite one to A at its own.
template <class S, bool kDense>
MW_INLINE void apply_at_anchors(const PartBodies<S>& s, typename S::Vec p, typename S::Vec arm_a,
                                typename S::Vec arm_b, PartVelocities<S, kDense>& v) {
  add_impulse(s.b, p, cross(arm_b, p), v.b);
  take_impulse(s.a, p, cross(arm_a, p), v.a);
}
template <class S, bool kDense>
MW_INLINE void apply_moments(const PartBodies<S>& s, typename S::Ang l,
                             PartVelocities<S, kDense>& v) {
  add_moment(s.b, l, v.b);
  take_moment(s.a, l, v.a);
}

// Inverse mass of a point at `arm` from the centre, as a matrix.
MW_INLINE void add_point_mass(const SideRows<Planar, Jointed>& side, Vec2 r, Sym2& k) {
  const Float inv_mass = Float::load(side.inv_mass), inertia = inertia_of(side);
  k.xx = k.xx + fma(r.y * r.y, inertia, inv_mass);
  k.xy = fnma(r.x * r.y, inertia, k.xy);
  k.yy = k.yy + fma(r.x * r.x, inertia, inv_mass);
}
MW_INLINE void add_point_mass(const SideRows<Tensor, Jointed>& side, Vec3 r, Sym3& k) {
  const Float inv_mass = Float::load(side.inv_mass);
  const Sym3 inertia = inertia_of(side);
  const Float zero(Real(0));
  const Vec3 x = mul(inertia, Vec3{zero, r.z, -r.y}), y = mul(inertia, Vec3{-r.z, zero, r.x}),
             z = mul(inertia, Vec3{r.y, -r.x, zero});
  k.xx = k.xx + (inv_mass + fms(x.y, r.z, x.z * r.y));
  k.xy = k.xy + fms(y.y, r.z, y.z * r.y);
  k.xz = k.xz + fms(z.y, r.z, z.z * r.y);
  k.yy = k.yy + (inv_mass + fms(y.z, r.x, y.x * r.z));
  k.yz = k.yz + fms(z.z, r.x, z.x * r.z);
  k.zz = k.zz + (inv_mass + fms(z.x, r.y, z.y * r.x));
}

// Speed of B's anchor against A's.
template <class S, bool kDense>
MW_INLINE typename S::Vec anchor_speed(const PartVelocities<S, kDense>& v, typename S::Vec arm_a,
                                       typename S::Vec arm_b) {
  return (v.b.v - v.a.v) + (cross(v.b.w, arm_b) - cross(v.a.w, arm_a));
}

// What B's point moves by against A's in a substep beyond h times their speed, over h. A row that
// is to be closed at the end of the substep takes it off its speed, so that bodies that rotate
// neither open their joints nor lose energy as they close: the impulses before and after the motion
// then are those of the trapezoidal rule, as in RATTLE (Andersen 1983). Of parts that are `curved`.
MW_INLINE Mask curved_lanes(const Work& w, const RowBodies& s) {
  return mask_from_bits(~(w.swept[s.body_a] | w.swept[s.body_b]));
}
template <class S>
MW_INLINE typename S::Vec curvature_between(const Work& w, const RowBodies& s,
                                            typename S::Vec arm_a, typename S::Vec arm_b) {
  return Curvature<S>(w, s.body_b).of(arm_b) - Curvature<S>(w, s.body_a).of(arm_a);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
