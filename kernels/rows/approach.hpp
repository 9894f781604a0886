// How the points of a manifold close during the step: which of them become rows, which touch, and
// how fast they are when they do.
#pragma once

#include "kernels/rows/sides.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Accelerations by gravity along the normal: of B from A, and the most that closes the gap when
// something holds A or B.
struct Pull {
  Float relative, closing;
};
template <class S, bool kPair>
MW_INLINE Pull pull_along(const Tables& t, const Group& g, const Sides<S, kPair>& sides,
                          typename S::Vec normal) {
  const Float zero(Real(0));
  if (!t.has_gravity && t.attractors == 0) return {zero, zero};
  const Float b = gravity_along<S>(t, g, sides.body_b, normal);
  if constexpr (!kPair) {
    return {b, b};
  } else {
    const bool uniform = t.uniform_gravity && t.attractors == 0;
    const Float a = uniform ? b : gravity_along<S>(t, g, sides.body_a, normal);
    const Float relative = b - a;
    return {relative, min(relative, min(b, -a))};
  }
}

// 1, or 0 in lanes whose rows look no farther than the gap of now. A body fast enough for a cast
// needs no speculation against a fixed shape, which could stop one that only passes by. Half spaces
// cannot be passed by, and height fields are not cast against.
template <class S, bool kPair>
MW_INLINE Float speculation_of(const Tables& t, const Group& g, const Sides<S, kPair>& sides,
                               kernels::PairKind kind) {
  const Float zero(Real(0)), one(Real(1)), dt(t.dt);
  if (kPair || !t.cast || is_plane(kind) || is_tile(kind)) return one;
  using Constants = kernels::BodyConstants<LaneNumber>;
  const std::uint32_t real = sides.body_b < Ints(t.bodies);
  const Float core = select(mask_from_bits(real),
                            gather_numbers<Constants>(constants_of_body(g, 0).core_radius,
                                                      select(real, sides.body_b, Ints(0))),
                            zero);
  const Float travel2 = dot(sides.velocity_b.v, sides.velocity_b.v) * (dt * dt);
  const Mask cast = (zero < core) & (square(core) < travel2);
  return select(cast, zero, one);
}

template <class S, int N>
struct Approach {
  using Ang = typename S::Ang;
  Ang arm_a[N], arm_b[N];        // r x n
  Ang turned_a[N], turned_b[N];  // the inverse inertia times that
  Float speed[N];                // along n at the start of the step, m/s; < 0: approaching
  Pull pull;
  Mask near, touching;  // lanes in which some point is within the margin, or will touch
};

// Takes points that stay beyond the margin out of the manifold.
template <class S, int N, bool kPair>
MW_INLINE void measure_approach(const Tables& t, const Group& g, const Sides<S, kPair>& sides,
                                kernels::PairKind kind, Mask active, Manifold<GeometryOf<S>, N>& m,
                                Approach<S, N>& out) {
  const Float zero(Real(0)), dt(t.dt), margin(t.margin);
  Float normal_speed = dot(m.normal, sides.velocity_b.v);
  if constexpr (kPair) normal_speed = dot(m.normal, sides.velocity_b.v - sides.velocity_a.v);
  const Pull pull = out.pull = pull_along<S>(t, g, sides, m.normal);
  const Float speculation = speculation_of<S>(t, g, sides, kind);
  out.near = out.touching = zero < zero;
  for (int i = 0; i < N; ++i) {
    out.arm_b[i] = cross(m.point_b[i], m.normal);
    out.turned_b[i] = apply(sides.b.inertia, out.arm_b[i]);
    Float v = normal_speed + dot(out.arm_b[i], sides.velocity_b.w);
    if constexpr (kPair) {
      out.arm_a[i] = cross(m.point_a[i], m.normal);
      out.turned_a[i] = apply(sides.a.inertia, out.arm_a[i]);
      v = v - dot(out.arm_a[i], sides.velocity_a.w);
    }
    out.speed[i] = v;
    const Float end_speed = fma(dt, pull.relative, v);
    const Float travel = dt * min(min(v, end_speed), zero) * speculation;
    m.valid[i] = m.valid[i] & active & (m.separation[i] + travel < margin);
    out.near = out.near | m.valid[i];
    const Float fall = dt * min(min(v, fma(dt, pull.closing, v)), zero) * speculation;
    out.touching = out.touching | (m.valid[i] & (m.separation[i] + fall < zero));
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
