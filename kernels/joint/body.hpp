// The bodies of a part: their masses, where they were when the step began, and how far the substeps
// have moved them since.
#pragma once

#include "kernels/lane/solve.hpp"
#include "kernels/motion/integrate.hpp"
#include "kernels/rows/body_rows.hpp"
#include "kernels/rows/velocities.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Joint = kernels::JointConstants<LaneNumber>;
using kernels::JointPart, kernels::PartKind;

MW_INLINE const Joint& constants_of_part(const Group& g, int part) {
  return reinterpret_cast<const Joint*>(g.constants.joint)[part];
}

// What all parts have. The world is a body that has no velocity and infinite mass.
template <class S>
struct alignas(64) PartBodies : RowBodies {
  SideRows<S, Free> a, b;
  Real impulse[kernels::kPartImpulses][kLanes];
};

template <class S, bool kDense>
using PartVelocities = RowVelocities<S, Free, kDense>;

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

MW_INLINE Rot2 compose(Rot2 a, Rot2 b) {
  return {fms(a.c, b.c, a.s * b.s), fma(a.s, b.c, a.c * b.s)};
}
MW_INLINE Quat compose(Quat a, Quat b) {
  return {fnma(a.z, b.z, fnma(a.y, b.y, fnma(a.x, b.x, a.w * b.w))),
          fnma(a.z, b.y, fma(a.y, b.z, fma(a.x, b.w, a.w * b.x))),
          fnma(a.x, b.z, fma(a.z, b.x, fma(a.y, b.w, a.w * b.y))),
          fnma(a.y, b.x, fma(a.x, b.y, fma(a.z, b.w, a.w * b.z)))};
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

// The rotation of a body by the substeps so far, as finish will apply it (rotate_by): R r - r of a
// vector.
template <class S>
struct SweptRotation {
  static constexpr int kNumbers = S::kAng + 1;
  typename S::Ang u;
  Float scale;
  MW_INLINE explicit SweptRotation(typename S::Ang swept) {
    u = swept * half_tangent_ratio(dot(swept, swept));
    scale = Float(Real(2)) / (Float(Real(1)) + dot(u, u));
  }
  // Of a body, which several parts may have; found by find_rotations.
  MW_INLINE SweptRotation(const Work& w, int body) {
    const Real* at = w.swept + body * kNumbers * kLanes;
    u = load_as<typename S::Ang>(at);
    scale = Float::load(at + S::kAng * kLanes);
  }
  MW_INLINE void store(const Work& w, int body) const {
    Real* at = w.swept + body * kNumbers * kLanes;
    manyworlds::MW_KERNEL_NAMESPACE::store(at, u);
    scale.store(at + S::kAng * kLanes);
  }
  MW_INLINE Vec3 change(Vec3 r) const {
    const Vec3 across = cross(u, r);
    return (across + cross(u, across)) * scale;
  }
  MW_INLINE Vec2 change(Vec2 r) const {
    const Vec2 across = cross(u, r);
    return (across + cross(u, across)) * scale;
  }
};

// Of all bodies that have parts, before these are refreshed: what two parts share is found once.
template <class S, bool kDense>
void find_rotations(const Constants& t, const Work& w) {
  for (int i = 0; i < t.jointed_bodies; ++i) {
    const int body = t.jointed[i];
    SweptRotation<S>(get_velocity<S, kDense>(w, w.displacement, body).w).store(w, body);
  }
  SweptRotation<S>(zero_of<typename S::Ang>()).store(w, world_body(t));
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
    const SweptRotation<S> swept_a(w, s.body_a), swept_b(w, s.body_b);
    const Vec change_a = swept_a.change(out.arm_a), change_b = swept_b.change(out.arm_b);
    out.arm_a = out.arm_a + change_a, out.arm_b = out.arm_b + change_b;
    out.moved_a = moved.a.v + change_a, out.moved_b = moved.b.v + change_b;
    out.gap = out.gap + (out.moved_b - out.moved_a);
    axis = axis + swept_a.change(axis);
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
MW_INLINE void add_point_mass(const SideRows<Planar, Free>& side, Vec2 r, Sym2& k) {
  const Float inv_mass = Float::load(side.inv_mass), inertia = inertia_of(side);
  k.xx = k.xx + fma(r.y * r.y, inertia, inv_mass);
  k.xy = fnma(r.x * r.y, inertia, k.xy);
  k.yy = k.yy + fma(r.x * r.x, inertia, inv_mass);
}
MW_INLINE void add_point_mass(const SideRows<Tensor, Free>& side, Vec3 r, Sym3& k) {
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

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
