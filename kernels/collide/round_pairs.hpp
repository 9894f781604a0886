// Spheres and circles against each other and against planes: one point, on the line of centres.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/shape/shapes.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

MW_INLINE Vec3 up_vector(Vec3) { return {Real(0), Real(0), Real(1)}; }
MW_INLINE Vec2 up_vector(Vec2) { return {Real(0), Real(1)}; }
inline constexpr Real kTinyDistance2 = sizeof(Real) == 4 ? Real(1e-20) : Real(1e-40);

// A point on the line of centres along `normal`; `reach` is from A's origin to A's surface. Apart,
// each body's anchor is on its own surface; in overlap they share the middle.
template <class S>
MW_INLINE void put_point(Manifold<S, 1>& m, typename S::Vec normal, Float separation, Float reach,
                         typename S::Vec d) {
  m.normal = normal;
  m.separation[0] = separation;
  const Float half(Real(0.5)), zero(Real(0));
  m.point_a[0] = normal * fma(min(separation, zero), half, reach);
  m.point_b[0] = normal * (reach + max(separation, separation * half)) - d;
  if constexpr (S::kDim == 3) m.tangent = any_tangent(normal);
  m.feature_x[0] = m.feature_y[0] = Real(0);
  m.code = Real(0);
  m.match_distance2 = Real(0);
  m.valid[0] = mask_from_bits(kAllLanes);
}

// Coincident centres separate along `fallback`.
template <class S, class Vec>
MW_INLINE void round_round(Manifold<S, 1>& m, Vec d, Float radius_a, Float radius_b, Vec fallback) {
  const Float d2 = dot(d, d);
  const Mask apart = Float(kTinyDistance2) < d2;
  const Float distance = sqrt(d2);
  const Float inv = Float(Real(1)) / select(apart, distance, Real(1));
  const Vec normal = select(apart, d * inv, fallback);
  const Float length = select(apart, distance, Real(0));
  put_point<S>(m, normal, length - radius_a - radius_b, radius_a, d);
}

template <class S>
struct SphereSphere {
  using A = SpherePose;
  using B = SpherePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    round_round<S>(m, b.p - a.p, a.radius, b.radius, up_vector(b.p));
  }
};

template <class S>
struct CircleCircle {
  using A = CirclePose;
  using B = CirclePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    round_round<S>(m, b.p - a.p, a.radius, b.radius, up_vector(b.p));
  }
};

// A fixed shape that would be the kernel's B: the kernel of the reverse order, with its sides
// exchanged.
template <class S, class Reverse>
struct Reversed {
  using A = typename Reverse::B;
  using B = typename Reverse::A;
  static constexpr int kPoints = Reverse::kPoints;
  static MW_INLINE void collide(const Constants& t, const A& a, const B& b, Float axis,
                                Manifold<S, kPoints>& m) {
    Reverse::collide(t, b, a, axis, m);
    m.normal = -m.normal;
    for (int i = 0; i < kPoints; ++i) {
      const auto point = m.point_a[i];
      m.point_a[i] = m.point_b[i];
      m.point_b[i] = point;
    }
  }
};

// Planes are fixed, so only point_b counts; A's origin is taken at B's.
template <class S, class Vec>
MW_INLINE void plane_round(Manifold<S, 1>& m, Vec normal, Vec tangent, Float offset, Vec p,
                           Float radius) {
  const Float separation = dot(normal, p) - offset - radius;
  m.normal = normal;
  if constexpr (S::kDim == 3) m.tangent = tangent;
  m.separation[0] = separation;
  m.point_b[0] = normal * -fma(min(separation, Real(0)), Real(0.5), radius);
  m.point_a[0] = m.point_b[0];
  m.feature_x[0] = m.feature_y[0] = Real(0);
  m.code = Real(0);
  m.match_distance2 = Real(0);
  m.valid[0] = mask_from_bits(kAllLanes);
}

template <class S>
struct PlaneSphere {
  using A = PlanePose;
  using B = SpherePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    plane_round<S>(m, a.normal, a.tangent, a.offset, b.p, b.radius);
  }
};

template <class S>
struct PlaneCircle {
  using A = PlanePose;
  using B = CirclePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    const Vec2 n{a.normal.x, a.normal.y};
    plane_round<S>(m, n, n, a.offset, b.p, b.radius);
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
