// Ball joints of trees: their rotation is eliminated at once, and their limits, a cone and a twist,
// are springs k between the rotations of both bodies, as Bound has them. With C the inverse of the
// child's moments of inertia about the anchor, M what couples those with its linear velocity, m the
// moment on the child and V the change of the parent's twist at the anchor, a limit about n
//   acts with      p = push / (1 + k n . C n) - g n . C m + g w . V,   g = k / (1 + k n . C n)
//   and goes on    as an inertia g w w',  w = (n, M' C n)
// to the parent, beside what a free ball passes on. The twist meets what the cone has left of C.
// All of k that is large stands below a fraction: hard limits cost no digits.
#pragma once

#include "kernels/direct/compliance.hpp"
#include "kernels/direct/edges.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// How a free ball joint gives way: what a wrench on the child leaves of force, and how the child
// turns under a moment where its anchor moves at v.
template <class S>
MW_INLINE Mat3 mixed_of(const BallFactors<S>& s) requires(S::kDim == 3) {
  return {load_vec3(s.mixed[0][0]), load_vec3(s.mixed[1][0]), load_vec3(s.mixed[2][0])};
}
template <class S>
MW_INLINE Wrench without_turn(const BallFactors<S>& s, const Wrench& p) requires(S::kDim == 3) {
  const Vec3 turn = mul(load_as<Sym3>(s.compliance[0]), p.n);
  return {zero_of<Vec3>(), p.f - mul_transposed(mixed_of(s), turn)};
}
template <class S>
MW_INLINE Vec3 turn_of(const BallFactors<S>& s, Vec3 moment, Vec3 v) requires(S::kDim == 3) {
  return mul(load_as<Sym3>(s.compliance[0]), moment - mul(mixed_of(s), v));
}
// L D L' of moments of inertia about an anchor. A thin rod under a heavy load has moments of 1 to
// 1e-7 of one another, and what is left of the load's inertia across it is as small a part of that:
// eliminated by the inverse, float would have no digit of it left; by the factors it is as good as
// the entries are (Higham 2002, 10.1).
class RotaryFactors {
 public:
  MW_INLINE explicit RotaryFactors(const Sym3& a) {
    const Float least = (a.xx + a.yy + a.zz) * Float(kLeast);
    const auto inverse_of = [&](Float pivot) { return inverse_or_zero(max(pivot, least)); };
    d0_ = inverse_of(a.xx);
    yx_ = a.xy * d0_, zx_ = a.xz * d0_;
    d1_ = inverse_of(fnma(yx_, a.xy, a.yy));
    const Float zy = fnma(yx_, a.xz, a.yz);
    zy_ = zy * d1_;
    d2_ = inverse_of(fnma(zy_, zy, fnma(zx_, a.xz, a.zz)));
  }
  MW_INLINE Sym3 inverse() const {
    const Float xz = fms(yx_, zy_, zx_), by_xz = xz * d2_, by_yz = zy_ * d2_;
    return {fma(xz, by_xz, fma(yx_ * yx_, d1_, d0_)),
            fnma(zy_, by_xz, -(yx_ * d1_)),
            by_xz,
            fma(zy_, by_yz, d1_),
            -by_yz,
            d2_};
  }
  // b - m' a^-1 m.
  MW_INLINE Sym3 without(const Mat3& m, const Sym3& b) const {
    const Vec3 x = reduced(m.x), y = reduced(m.y), z = reduced(m.z), by_x = scaled(x),
               by_y = scaled(y), by_z = scaled(z);
    return {b.xx - dot(x, by_x), b.xy - dot(x, by_y), b.xz - dot(x, by_z),
            b.yy - dot(y, by_y), b.yz - dot(y, by_z), b.zz - dot(z, by_z)};
  }

 private:
  // Of the sum of the moments: the least that a pivot is taken to be.
  static constexpr Real kLeast = sizeof(Real) == 4 ? Real(1e-6) : Real(1e-14);
  MW_INLINE Vec3 reduced(Vec3 a) const {
    const Float y = fnma(yx_, a.x, a.y);
    return {a.x, y, fnma(zy_, y, fnma(zx_, a.x, a.z))};
  }
  MW_INLINE Vec3 scaled(Vec3 a) const { return {a.x * d0_, a.y * d1_, a.z * d2_}; }

  Float d0_, d1_, d2_, yx_, zx_, zy_;  // 1 / D, L
};
template <class S>
MW_INLINE void eliminate_rotation(BallFactors<S>& to,
                                  ArticulatedInertia& inertia) requires(S::kDim == 3) {
  const RotaryFactors factors(inertia.rotary);
  const Mat3 m = inertia.mixed;
  store(to.compliance[0], factors.inverse());
  store(to.mixed[0][0], m.x), store(to.mixed[1][0], m.y), store(to.mixed[2][0], m.z);
  inertia.linear = factors.without(m, inertia.linear);
}

// Along the axes of a cone and of a twist.
struct BallImpulses {
  Float cone, twist;
};

// The limits of an edge, by a set of factors. Theirs lie where other joints have those of their
// coordinates: `response` is w, `inverse` 1 / (1 + k n . C n), `pivot` 1 / (n . C n).
template <class S>
class BallLimits {
 public:
  BallLimits(const TreeEdge& edge, const EdgeRows<S>& s, const EdgeFactors<S>& f)
      : cone_(edge.cone >= 0), twist_(edge.angle >= 0), s_(s), f_(f) {}

  // After eliminate_rotation. cone(pivot), twist(pivot): their stiffness.
  template <class OfCone, class OfTwist>
  static void eliminate(const TreeEdge& edge, const EdgeRows<S>& s, EdgeFactors<S>& f,
                        ArticulatedInertia& inertia, OfCone cone, OfTwist twist) {
    const auto compliance = load_as<Sym3>(f.ball.compliance[0]);
    const Vec3 none = zero_of<Vec3>();
    inertia.rotary = Sym3{none.x, none.x, none.x, none.x, none.x, none.x};
    inertia.mixed = {none, none, none};
    Vec3 n_cone = none, by_cone = none;
    Float share(Real(0));  // of the cone
    const auto limit = [&](DofFactors<S>& to, Vec3 axis, auto stiffness) {
      Vec3 by = mul(compliance, axis);
      const Float met = share * dot(by_cone, axis);
      const Vec3 n = fnma(n_cone, met, axis);
      by = fnma(by_cone, met, by);
      const Float give = dot(axis, by), pivot = inverse_or_zero(give);
      const Float inverse = Float(Real(1)) / fma(stiffness(pivot), give, Float(Real(1)));
      const Wrench w{n, mul_transposed(mixed_of(f.ball), by)};
      store(to.response[0], w), pivot.store(to.pivot), inverse.store(to.inverse);
      n_cone = n, by_cone = by, share = share_of(to);
      inertia = without(inertia, w, -share);
    };
    if (edge.cone >= 0) limit(f.slide, load_vec3(s.slide_axis[0]), cone);
    if (edge.angle >= 0) limit(f.turn, load_vec3(s.turn_axis[0]), twist);
  }

  // What they do under a moment on the child, with the parent at rest; `push` of both.
  MW_INLINE BallImpulses at_rest(Vec3 moment, const BallImpulses& push) const {
    const auto compliance = load_as<Sym3>(f_.ball.compliance[0]);
    BallImpulses out{Float(Real(0)), Float(Real(0))};
    if (cone_) {
      const auto n = load_vec3(s_.slide_axis[0]);
      out.cone = act(f_.slide, push.cone, dot(n, mul(compliance, moment)));
      moment = fma(n, out.cone, moment);
    }
    if (twist_) {
      const auto n = load_vec3(s_.turn_axis[0]);
      out.twist = act(f_.turn, push.twist, dot(n, mul(compliance, moment)));
    }
    return out;
  }
  MW_INLINE BallImpulses at_rest(Vec3 moment) const {
    return at_rest(moment, {Float(Real(0)), Float(Real(0))});
  }
  // What goes on to the parent of a wrench on the child.
  MW_INLINE Wrench pass(const Wrench& p, const BallImpulses& at_rest) const {
    Wrench out = without_turn(f_.ball, p);
    if (cone_) out = fnma(response(f_.slide), at_rest.cone, out);
    if (twist_) out = fnma(response(f_.turn), at_rest.twist, out);
    return out;
  }
  // How the child turns, where the parent's twist at the anchor changes by v; p becomes what the
  // limits do then.
  MW_INLINE Vec3 turn(Vec3 moment, const Twist& v, BallImpulses& p) const {
    const auto add = [&](const DofFactors<S>& f, Float& impulse) {
      impulse = fma(share_of(f), dot(v, response(f)), impulse);
      moment = fma(load_vec3(f.response[0]), impulse, moment);
    };
    if (cone_) add(f_.slide, p.cone);
    if (twist_) add(f_.turn, p.twist);
    if (cone_ && twist_) {
      const Float met = dot(load_vec3(s_.slide_axis[0]), load_vec3(f_.turn.response[0]));
      p.cone = fma(met, p.twist, p.cone);
    }
    return turn_of(f_.ball, moment, v.v);
  }
  // Compliance of the child, by that of the parent at the anchor.
  SpatialCompliance beyond(const SpatialCompliance& parent) const {
    const Float zero(Real(0)), one(Real(1));
    const Vec3 none{zero, zero, zero},
        unit[3] = {{one, zero, zero}, {zero, one, zero}, {zero, zero, one}};
    Vec3 angular[3], mixed[3], linear[3];
    for (int i = 0; i < 3; ++i) {
      angular[i] = response_to({unit[i], none}, parent).w;
      const Twist v = response_to({none, unit[i]}, parent);
      mixed[i] = v.w, linear[i] = v.v;
    }
    return {{angular[0].x, angular[0].y, angular[0].z, angular[1].y, angular[1].z, angular[2].z},
            {mixed[0], mixed[1], mixed[2]},
            {linear[0].x, linear[0].y, linear[0].z, linear[1].y, linear[1].z, linear[2].z}};
  }

 private:
  static MW_INLINE Wrench response(const DofFactors<S>& f) {
    return load_as<Wrench>(f.response[0]);
  }
  static MW_INLINE Float share_of(const DofFactors<S>& f) {  // g
    return (Float(Real(1)) - Float::load(f.inverse)) * Float::load(f.pivot);
  }
  static MW_INLINE Float act(const DofFactors<S>& f, Float push, Float rate) {
    return fms(push, Float::load(f.inverse), share_of(f) * rate);
  }
  MW_INLINE Twist response_to(const Wrench& p, const SpatialCompliance& parent) const {
    BallImpulses impulses = at_rest(p.n);
    const Twist v = mul(parent, pass(p, impulses));
    return {turn(p.n, v, impulses), v.v};
  }

  const bool cone_, twist_;
  const EdgeRows<S>& s_;
  const EdgeFactors<S>& f_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
