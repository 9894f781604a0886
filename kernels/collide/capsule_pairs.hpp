// Capsules against spheres, circles and planes, in the plane and in space alike. A capsule is all
// that is within its radius of its axis, a line from -half to +half about its origin.
#pragma once

#include "kernels/collide/plane_box.hpp"
#include "kernels/collide/round_pairs.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Point i of a manifold: `reach` beyond the point `base` of A, both from A's origin. Apart, each
// body's anchor is on its own surface; in overlap they share the middle.
template <class S, int N>
MW_INLINE void put_point(Manifold<S, N>& m, int i, typename S::Vec base, Float reach,
                         Float separation, typename S::Vec d) {
  const Float half(Real(0.5)), zero(Real(0));
  m.separation[i] = separation;
  m.point_a[i] = fma(m.normal, fma(min(separation, zero), half, reach), base);
  m.point_b[i] = fma(m.normal, reach + max(separation, separation * half), base) - d;
}

// Points from `first` on are none; they repeat the first one.
template <class S, int N>
MW_INLINE void leave_out_points(Manifold<S, N>& m, int first) {
  for (int i = first; i < N; ++i) {
    m.point_a[i] = m.point_a[0], m.point_b[i] = m.point_b[0];
    m.separation[i] = m.separation[0];
    m.feature_x[i] = m.feature_x[0], m.feature_y[i] = m.feature_y[0];
    m.valid[i] = mask_from_bits(0);
  }
}

// One point, at the place on the axis that is nearest to the centre. A centre on the axis is moved
// out across it.
template <class S, class Round>
struct CapsuleRound {
  using A = CapsulePose<typename S::Vec>;
  using B = Round;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    const auto d = b.p - a.p;
    const auto nearest = a.axis * clamp(dot(a.axis, d), -a.half, a.half);
    round_round<S>(m, d - nearest, a.radius, b.radius, across(a.axis));
    m.point_a[0] = m.point_a[0] + nearest;
  }
};

MW_INLINE Vec3 normal_of(const PlanePose& p, Vec3) { return p.normal; }
MW_INLINE Vec2 normal_of(const PlanePose& p, Vec2) { return {p.normal.x, p.normal.y}; }

// Two points, below the ends of the axis, whose places along it are their features.
template <class S>
struct PlaneCapsule {
  using A = PlanePose;
  using B = CapsulePose<typename S::Vec>;
  static constexpr int kPoints = S::kMulti;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, kPoints>& m) {
    m.normal = normal_of(a, b.p);
    if constexpr (S::kDim == 3) m.tangent = a.tangent;
    const Float height = dot(m.normal, b.p) - a.offset - b.radius;
    for (int i = 0; i < 2; ++i) {
      const Float place = i == 0 ? -b.half : b.half;
      const auto end = b.axis * place;
      m.separation[i] = height + dot(m.normal, end);
      m.point_b[i] = fnma(m.normal, fma(min(m.separation[i], Real(0)), Real(0.5), b.radius), end);
      m.point_a[i] = m.point_b[i];
      m.feature_x[i] = place;
      m.feature_y[i] = Real(0);
      m.valid[i] = mask_from_bits(kAllLanes);
    }
    leave_out_points(m, 2);
    m.code = Real(0);
    m.match_distance2 = match_distance2(b.half);
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
