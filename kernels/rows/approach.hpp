// How the points of a manifold close during the step: which of them become rows, which touch, and
// how fast they are when they do.
#pragma once

#include "kernels/collide/cast.hpp"
#include "kernels/rows/sides.hpp"
#include "kernels/work/half_turn.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// What forces, controls and attractors accelerate the bodies of the lanes by, along the normal.
// Exactly zero in lanes without any, whatever the others have.
template <class S, bool kDense>
MW_INLINE Float load_along(const Constants& t, const Group& g, const Work& w, Ints bodies,
                           const std::int32_t* offset, int body, typename S::Vec normal) {
  using OfBody = kernels::BodyConstants<LaneNumber>;
  auto load = load_velocity<S, kDense>(w.delta_v, offset, body).v;
  const auto& own = constants_of_body(g, 0).delta_v;
  load.x = load.x - gather_numbers<OfBody>(own[0], bodies);
  load.y = load.y - gather_numbers<OfBody>(own[1], bodies);
  if constexpr (S::kDim == 3) load.z = load.z - gather_numbers<OfBody>(own[2], bodies);
  return dot(load, normal) * Float(t.inv_h);
}

// Accelerations along the normal before any contact acts: of B from A, and the most that closes the
// gap when something holds A or B.
struct Pull {
  Float relative, closing;
};
template <class S, bool kDense, class A>
MW_INLINE Pull pull_along(const Constants& t, const Group& g, const Work& w, const RowBodies& s,
                          const Sides<S, A>& sides, typename S::Vec normal) {
  const Float zero(Real(0));
  if (!t.has_gravity && !w.delta_v) return {zero, zero};
  Float b = dot(gravity_of<S>(t, g, sides.body_b), normal);
  const Float gravity = b;
  if (w.delta_v) {
    b = b + load_along<S, kDense>(t, g, w, sides.body_b, s.offset_b, kDense ? s.body_b : 0, normal);
  }
  if constexpr (!A::kMoves) {
    return {b, b};
  } else {
    Float a = t.uniform_gravity ? gravity : dot(gravity_of<S>(t, g, sides.body_a), normal);
    if (w.delta_v) {
      a = a +
          load_along<S, kDense>(t, g, w, sides.body_a, s.offset_a, kDense ? s.body_a : 0, normal);
    }
    const Float relative = b - a;
    return {relative, min(relative, min(b, -a))};
  }
}

// 1, or 0 in lanes whose rows look no farther than the gap of now. A body fast enough for a cast
// needs no speculation against a fixed shape, which could stop one that only passes by. Within
// `cast_gap` of a shape, rows are speculative again, including for points that do not touch yet.
// Half spaces and height fields cannot be passed by.
template <class S, class A>
MW_INLINE Float speculation_of(const Constants& t, const Group& g, const Sides<S, A>& sides,
                               kernels::PairKind kind, Float deepest) {
  const Float zero(Real(0)), one(Real(1)), dt(t.dt);
  if (A::kMoves || !t.cast || is_plane(kind) || is_tile(kind)) return one;
  using OfBody = kernels::BodyConstants<LaneNumber>;
  const std::uint32_t real = sides.body_b < Ints(t.bodies);
  const Float core = select(mask_from_bits(real),
                            gather_numbers<OfBody>(constants_of_body(g, 0).half_thickness,
                                                   select(real, sides.body_b, Ints(0))),
                            zero);
  const Float travel2 = dot(sides.b.velocity.v, sides.b.velocity.v) * (dt * dt);
  const Mask cast = (zero < core) & (square(core) < travel2) & (cast_gap(t, core) < deepest);
  return select(cast, zero, one);
}

// The points of a manifold as one side has them.
template <class S, int N, class Side>
struct SideArms {};
template <class S, int N>
struct SideArms<S, N, Free> {
  using Ang = typename S::Ang;
  Ang arm[N];       // r x n
  Ang response[N];  // the inverse inertia times that

  // Speed of point i along the normal by the rotation of this side.
  MW_INLINE Float set(int i, const SideState<S, Free>& side, typename S::Vec point,
                      typename S::Vec normal) {
    arm[i] = cross(point, normal);
    response[i] = apply(side.body.inertia, arm[i]);
    return dot(arm[i], side.velocity.w);
  }
};

// What the sides are turned ahead by.
template <class S, class A>
struct SideTurns {
  typename S::Ang a, b;
  // Whether any lane is.
  MW_INLINE bool find(const Constants& t, const Sides<S, A>& sides) {
    b = half_turn(t, sides.b.velocity.w);
    Float sum = dot(b, b);
    if constexpr (A::kMoves) {
      a = half_turn(t, sides.a.velocity.w);
      sum = sum + dot(a, a);
    }
    return any(Float(Real(0)) < sum);
  }
  // By how much that moves a point along the normal.
  template <class ArmsA, class ArmsB>
  MW_INLINE Float along(const ArmsA& arms_a, const ArmsB& arms_b, int i) const {
    Float x = dot(arms_b.arm[i], b);
    if constexpr (A::kMoves) x = x - dot(arms_a.arm[i], a);
    return x;
  }
};

template <class S, int N, class A>
struct Approach {
  SideArms<S, N, A> a;
  SideArms<S, N, Free> b;
  Float speed[N];  // along n at the start of the step, m/s; < 0: approaching
  Pull pull;
  Mask close[N];  // in which a point is within the margin in this step
  Mask near;      // in which one may come to be
  Mask touching;  // in which one will touch

  // What an impulse at point i does to the speed of point j, by rotation and all.
  MW_INLINE Float coupling(Float inv_mass, int i, int j) const {
    Float k = inv_mass + dot(b.arm[i], b.response[j]);
    if constexpr (A::kMoves) k = k + dot(a.arm[i], a.response[j]);
    return k;
  }
};

// A manifold that has a close point keeps the others, too: pushed at the one, bodies turn on to
// them. Not guards against fixed shapes, which would brake what rolls on them.
template <bool kDense, class S, int N, class A>
MW_INLINE void measure_approach(const Constants& t, const Group& g, const Work& w,
                                const RowBodies& s, const Sides<S, A>& sides,
                                kernels::PairKind kind, Mask active, Manifold<GeometryOf<S>, N>& m,
                                Approach<S, N, A>& out) {
  const Float zero(Real(0)), dt(t.dt), margin(t.margin);
  Float normal_speed = dot(m.normal, sides.b.velocity.v);
  if constexpr (A::kMoves) {
    normal_speed = dot(m.normal, relative_velocity(sides.a.velocity, sides.b.velocity));
  }
  const Pull pull = out.pull = pull_along<S, kDense>(t, g, w, s, sides, m.normal);
  Float deepest = margin;
  for (int i = 0; i < N; ++i) deepest = min(deepest, select(m.valid[i], m.separation[i], margin));
  const Float speculation = speculation_of(t, g, sides, kind, deepest);
  out.near = out.touching = zero < zero;
  SideTurns<S, A> turns;
  const bool ahead = looks_ahead(t, w) && turns.find(t, sides);
  const bool springs = t.solver.kind == kernels::Solver::penalty;
  for (int i = 0; i < N; ++i) {
    Float v = normal_speed + out.b.set(i, sides.b, m.point_b[i], m.normal);
    if constexpr (A::kMoves) v = v - out.a.set(i, sides.a, m.point_a[i], m.normal);
    out.speed[i] = v;
    if (ahead) m.separation[i] = m.separation[i] - turns.along(out.a, out.b, i);
    const Float end_speed = fma(dt, pull.relative, v);
    const Float way = dt * min(v, end_speed), travel = min(way, zero) * speculation;
    m.valid[i] = m.valid[i] & active;
    if constexpr (!A::kMoves) m.valid[i] = m.valid[i] & !m.guard[i];
    out.close[i] = (m.valid[i] & !m.guard[i]) & (m.separation[i] + travel < margin);
    out.near = out.near | out.close[i];
    const Float fall = dt * min(min(v, fma(dt, pull.closing, v)), zero) * speculation;
    Mask touches = out.close[i] & (m.separation[i] + fall < zero);
    // What overlaps, if only by rounding, and leaves has no impulse to wait for, but of springs,
    // which push whatever overlaps.
    if (!springs) touches = touches & (m.separation[i] + way < margin);
    out.touching = out.touching | touches;
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
