// The rotation of bodies with joints since the start of the step.
//
// In space such a body rotates in each substep as a free body does (rotate.hpp): its angular
// momentum stays, and its axes and inverse inertia follow. One rotation by the sum of w h at the
// end of the step misses terms of second order, whatever the substep, and wastes the angular
// momentum. Rows of contacts are those of the start of the step. Where they may act on a body it
// rotates by the vector that its angular velocity sweeps, with the inertia of the start, as bodies
// without joints do. In the plane both are the same.
#pragma once

#include "kernels/motion/integrate.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// R r - r of a vector, exact to its own digits where the rotation is small.
template <class S>
struct Rotation {
  static constexpr int kNumbers = 4;
  Quat q;
  MW_INLINE explicit Rotation(Quat from) : q(from) {}
  MW_INLINE explicit Rotation(Vec3 swept) {  // as rotate_by does
    const Vec3 half = swept * half_tangent_ratio(dot(swept, swept));
    q.w = Float(Real(1)) / sqrt(dot(half, half) + Float(Real(1)));
    q.x = half.x * q.w, q.y = half.y * q.w, q.z = half.z * q.w;
  }
  MW_INLINE explicit Rotation(const Real* at) : q(load_quat(at)) {}
  MW_INLINE void store(Real* at) const { manyworlds::MW_KERNEL_NAMESPACE::store(at, q); }
  MW_INLINE Vec3 change(Vec3 r) const {
    const Vec3 u{q.x, q.y, q.z}, across = cross(u, r), half = fma(across, q.w, cross(u, across));
    return half + half;
  }
};
template <>
struct Rotation<Planar> {
  static constexpr int kNumbers = 2;
  Float tangent, scale;  // of half the angle; 2 / (1 + tangent^2)
  MW_INLINE explicit Rotation(Float swept) : tangent(swept * half_tangent_ratio(swept * swept)) {
    scale = Float(Real(2)) / (Float(Real(1)) + tangent * tangent);
  }
  MW_INLINE explicit Rotation(const Real* at)
      : tangent(Float::load(at)), scale(Float::load(at + kLanes)) {}
  MW_INLINE void store(Real* at) const { tangent.store(at), scale.store(at + kLanes); }
  MW_INLINE Vec2 change(Vec2 r) const {
    const Vec2 across = cross(tangent, r);
    return (across + cross(tangent, across)) * scale;
  }
};

// Rows of Work::rotation, of each body: the rotation, those of Curvature, and in space the inverse
// inertia, half of what the angular velocity changes by in a substep of free rotation, the
// principal axes, and the orientation at the start of the step.
template <class S>
inline constexpr int kCurvatureRow = Rotation<S>::kNumbers;
template <class S>
inline constexpr int kInertiaRow = kCurvatureRow<S> + S::kAng + 2;
template <class S>
inline constexpr int kRotationRows = kInertiaRow<S> +
                                     (S::kDim == 3 ? S::kInertia + S::kAng + 9 + 4 : 0);
template <class S>
MW_INLINE Real* rotation_rows(const Work& w, int body) {
  return w.rotation + body * kRotationRows<S> * kLanes;
}
template <class S>
MW_INLINE Rotation<S> rotation_of(const Work& w, int body) {
  return Rotation<S>(rotation_rows<S>(w, body));
}
template <class S>
MW_INLINE Real* curvature_rows(const Work& w, int body) {
  return rotation_rows<S>(w, body) + kCurvatureRow<S> * kLanes;
}
MW_INLINE Real* rotated_inertia(const Work& w, int body) {
  return rotation_rows<Tensor>(w, body) + kInertiaRow<Tensor> * kLanes;
}
MW_INLINE Real* half_change(const Work& w, int body) {
  return rotated_inertia(w, body) + Tensor::kInertia * kLanes;
}
MW_INLINE Real* principal_axes(const Work& w, int body) {
  return half_change(w, body) + Tensor::kAng * kLanes;
}
MW_INLINE Real* start_orientation(const Work& w, int body) {
  return principal_axes(w, body) + 9 * kLanes;
}

// What a point of a body at r moves by in a substep beyond h times its velocity, over h, where the
// joints of the body are to close:
//   (R r - r) / h - w x r = (a (p x r) + b p x (p x r)) / h + d x r
// with the rotation p = h (w + d) of the substep, d half of what w changes by in it, a = sin |p| /
// |p| - 1 and b = (1 - cos |p|) / |p|^2.
//
// The rotation is a prediction. Where it is too large the joints give energy, where it is too small
// they take some: a share is left to the gap, which closes what is missing. From 0.95 on single
// bodies on ball joints gain energy at half a radian in a step (tests/joint/joint_top_test.cpp),
// and a double pendulum gains half of its energy in 20 s, since no pass solves both of its joints:
// so only joints that are alone are curved. What contacts act on is not, either.
inline constexpr Real kCurvedShare = Real(0.85);
inline constexpr Real kMostCurved = Real(0.25);  // rad; what rotates faster curves as this does
template <class S>
struct Curvature {
  typename S::Ang angle, change;
  Float along, across;
  // `spin`: the angular velocity of the motion, as far as it is known.
  MW_INLINE Curvature(const Constants& t, const Work& w, int body, typename S::Ang spin)
      : angle(spin) {
    load_change(w, body);
    angle = (spin + change) * Float(t.h);
    // Taylor series, exact to 1e-7 at 1 rad; the share bounds what comes of them.
    const Float x = min(dot(angle, angle), Real(4)), inv_h(t.inv_h), one(Real(1));
    const auto term = [&](Real divisor, Float next) {
      return fnma(x * Float(1 / divisor), next, one);
    };
    const Float most(kMostCurved * kMostCurved);
    const Float share = select(mask_from_bits(w.swept[body]), Real(0),
                               most * Float(kCurvedShare) / max(dot(angle, angle), most));
    change = change * share;
    along = x * (share * inv_h * Float(Real(-1.0 / 6))) * term(20, term(42, term(72, one)));
    across = share * inv_h * Float(Real(0.5)) * term(12, term(30, term(56, one)));
  }
  MW_INLINE Curvature(const Work& w, int body) {
    const Real* at = curvature_rows<S>(w, body);
    angle = load_as<typename S::Ang>(at);
    along = Float::load(at + S::kAng * kLanes), across = Float::load(at + (S::kAng + 1) * kLanes);
    load_change(w, body);
  }
  MW_INLINE void store(const Work& w, int body) const {
    Real* at = curvature_rows<S>(w, body);
    manyworlds::MW_KERNEL_NAMESPACE::store(at, angle);
    along.store(at + S::kAng * kLanes), across.store(at + (S::kAng + 1) * kLanes);
  }
  MW_INLINE typename S::Vec of(typename S::Vec r) const {
    const auto turn = cross(angle, r);
    const auto out = fma(turn, along, cross(angle, turn) * across);
    if constexpr (S::kDim == 2) {
      return out;
    } else {
      return out + cross(change, r);
    }
  }

 private:
  MW_INLINE void load_change(const Work& w, int body) {
    change = zero_of<typename S::Ang>();
    if constexpr (S::kDim == 3) change = load_vec3(half_change(w, body));
  }
};

MW_INLINE Vec3 vector_of(const LaneNumber (&v)[3]) { return {v[0], v[1], v[2]}; }

// The principal axes of a body in the order in which it is split, the middle one second.
class AxisOrder {
 public:
  MW_INLINE explicit AxisOrder(int middle)
      : first_(middle == 0 ? 2 : middle - 1),
        middle_(middle),
        last_(middle == 2 ? 0 : middle + 1) {}
  MW_INLINE Vec3 of(const LaneNumber (&c)[3]) const { return {c[first_], c[middle_], c[last_]}; }
  // Of a body's axes so ordered, from that of its frame.
  MW_INLINE Quat orientation(Quat q) const {
    if (middle_ == 1) return q;
    const Float half(Real(0.5)), by(middle_ == 2 ? Real(0.5) : Real(-0.5));
    return compose(q, Quat{half, by, by, by});
  }

 private:
  int first_, middle_, last_;
};

// At the start of a step, once contacts are found and before joints touch anything.
template <class S>
void start_rotations(const Constants& t, const Group& g, const Work& w) {
  const Rotation<S> none(zero_of<typename S::Ang>());
  for (int i = 0; i < t.jointed_bodies; ++i) {
    const int body = t.jointed[i];
    none.store(rotation_rows<S>(w, body));
    w.swept[body] = t.body[body].kinematic ? kAllLanes : t.has_contacts ? w.touched[body] : 0;
    if constexpr (S::kDim == 3) {
      const auto& constants = constants_of_body(g, body);
      const AxisOrder order(t.body[body].middle);
      const Quat q =
          order.orientation(normalize(load_quat(state_of(t, g, body, kState<S>.orientation))));
      const Mat3 axes = matrix(q);
      store(start_orientation(w, body), q), store(principal_axes(w, body), axes);
      store(rotated_inertia(w, body), rotate_diagonal(axes, order.of(constants.inv_inertia)));
      const Vec3 spin = mul_transposed(axes, load_vec3(state_of(t, g, body, kState<S>.angular)));
      const Vec3 inertia = order.of(constants.principal.inertia),
                 inverse = order.of(constants.principal.inverse);
      const Vec3 pull = times(cross(times(spin, inertia), spin), inverse);
      const Vec3 change = mul(axes, pull * Float(t.h * Real(0.5)));
      const Mask swept = mask_from_bits(w.swept[body]);
      store(half_change(w, body), select(swept, zero_of<Vec3>(), change));
    }
  }
  w.swept[world_body(t)] = 0;
  Real* world = rotation_rows<S>(w, world_body(t));
  for (int k = 0; k < kRotationRows<S>; ++k) Float(Real(0)).store(world + k * kLanes);
  none.store(world);
}

// Rotates `count` bodies over a substep, and their angular velocities with them: two side by side,
// to hide the latency of the splitting, or one twice, to be stored once.
template <bool kDense>
void rotate_jointed(const Constants& t, const Group& g, const Work& w,
                    const std::int32_t (&bodies)[2], int count) {
  constexpr int kBodies = 2;
  const std::uint32_t swept_everywhere = w.swept[bodies[0]] & w.swept[bodies[1]];
  Velocity<Tensor> v[kBodies], way[kBodies];
  Vec3 own[kBodies], before[kBodies];  // angular velocity and momentum in body axes
  Rates rates[kBodies];
  Spin spin[kBodies];
  for (int i = 0; i < kBodies; ++i) {
    way[i] = get_velocity<Tensor, kDense>(w, w.displacement, bodies[i]);
    if (swept_everywhere == kAllLanes) {
      Rotation<Tensor>(way[i].w).store(rotation_rows<Tensor>(w, bodies[i]));
    }
  }
  if (swept_everywhere == kAllLanes) return;
  for (int i = 0; i < kBodies; ++i) {
    const PrincipalInertia& top = constants_of_body(g, bodies[i]).principal;
    const AxisOrder order(t.body[bodies[i]].middle);
    v[i] = get_velocity<Tensor, kDense>(w, w.velocity, bodies[i]);
    own[i] = mul_transposed(load_as<Mat3>(principal_axes(w, bodies[i])), v[i].w);
    const Vec3 inverse = order.of(top.inverse);
    const Float h(t.h), half = h * Float(Real(0.5)), one(Real(1)), zero(Real(0));
    rates[i] = {inverse.x * half, inverse.y * half, inverse.z * h};
    spin[i] = {times(own[i], order.of(top.inertia)), {one, zero, zero, zero}};
    before[i] = spin[i].l;
  }
  Mask far[kBodies], some = mask_from_bits(0);
  split_about_y<kBodies>(rates, spin, far);
  for (int i = 0; i < kBodies; ++i) some = some | far[i];
  if (any(some)) {
    for (int i = 0; i < kBodies; ++i) {
      const PrincipalInertia& top = constants_of_body(g, bodies[i]).principal;
      const Float one(Real(1)), zero(Real(0));
      const Vec3 inverse = AxisOrder(t.body[bodies[i]].middle).of(top.inverse);
      const Float bound = Float(top.angle_bound) * Float(t.h / t.dt);
      Spin fast{before[i], {one, zero, zero, zero}};
      split_fast(rates[i], angle2(fast.l, times(fast.l, inverse), bound), fast);
      spin[i] = {select(far[i], fast.l, spin[i].l), select(far[i], fast.q, spin[i].q)};
    }
  }
  for (int i = 0; i < count; ++i) {
    const auto& constants = constants_of_body(g, bodies[i]);
    const AxisOrder order(t.body[bodies[i]].middle);
    Real* rows = principal_axes(w, bodies[i]);
    const Quat turn = normalize(spin[i].q);
    const Vec3 axis = mul(load_as<Mat3>(rows), Vec3{turn.x, turn.y, turn.z});
    Rotation<Tensor> now(
        compose(Quat{turn.w, axis.x, axis.y, axis.z}, rotation_of<Tensor>(w, bodies[i]).q));
    Mat3 axes = matrix(compose(now.q, load_quat(start_orientation(w, bodies[i]))));
    Sym3 inertia = rotate_diagonal(axes, order.of(constants.inv_inertia));
    const std::uint32_t swept_bits = w.swept[bodies[i]];
    const Mask swept = mask_from_bits(swept_bits);
    if (swept_bits != 0) {
      axes = select(swept, load_as<Mat3>(rows), axes);
      inertia = select(swept, load_as<Sym3>(rotated_inertia(w, bodies[i])), inertia);
    }
    store(rows, axes);
    // By what L changes in body axes: L over I itself would leave a rounding that adds up.
    const Vec3 changed = times(spin[i].l - before[i], order.of(constants.principal.inverse));
    Vec3 omega = mul(axes, own[i] + changed);
    // The body sweeps h times the mean of both velocities.
    Vec3 change = (omega - v[i].w) * Float(Real(0.5)), sweep = fma(change, Float(t.h), way[i].w);
    if (swept_bits != 0) {
      now.q = select(swept, Rotation<Tensor>(way[i].w).q, now.q);
      omega = select(swept, v[i].w, omega), sweep = select(swept, way[i].w, sweep);
      change = select(swept, zero_of<Vec3>(), change);
    }
    v[i].w = omega, way[i].w = sweep;
    now.store(rotation_rows<Tensor>(w, bodies[i]));
    store(rotated_inertia(w, bodies[i]), inertia);
    store(half_change(w, bodies[i]), change);
    put_spin<kDense>(w, w.velocity, bodies[i], v[i]);
    put_spin<kDense>(w, w.displacement, bodies[i], way[i]);
  }
}

// All bodies with joints, after displacements advance.
template <class S, bool kDense>
void rotate_jointed_bodies(const Constants& t, const Group& g, const Work& w) {
  if constexpr (S::kDim == 2) {
    for (int i = 0; i < t.jointed_bodies; ++i) {
      const int body = t.jointed[i];
      Rotation<S>(get_velocity<S, kDense>(w, w.displacement, body).w)
          .store(rotation_rows<S>(w, body));
    }
  } else {
    for (int i = 0; i < t.jointed_bodies; i += 2) {
      const int count = i + 1 < t.jointed_bodies ? 2 : 1;
      rotate_jointed<kDense>(t, g, w, {t.jointed[i], t.jointed[i + count - 1]}, count);
    }
  }
}

// A body that a cast stops has rotated by `swept` in `lanes` instead.
MW_INLINE void put_rotation(const Work& w, int body, Mask lanes, Vec3 swept) {
  const Quat q = rotation_of<Tensor>(w, body).q;
  store(rotation_rows<Tensor>(w, body), select(lanes, Rotation<Tensor>(swept).q, q));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
