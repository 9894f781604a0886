// Convex polygons of 3 to 8 vertices against each other, circles and half-planes. Loops run over
// kMaxVertices in every lane.
#pragma once

#include "kernels/collide/round_pairs.hpp"
#include "kernels/collide/segments.hpp"
#include "kernels/shape/shapes.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct PolygonPolygon {
  using A = PolygonPose;
  using B = PolygonPose;
  static constexpr int kPoints = 2;
  static MW_INLINE void collide(const Constants& t, const A& a, const B& b, Float,
                                Manifold<S, 2>& m) {
    const Float half(Real(0.5)), zero(Real(0));
    const PolygonCorners ca = load_corners(a), cb = load_corners(b);
    const Vec2 d = b.p - a.p;
    const PolygonEdge edge_a = farthest_edge(ca, cb, d), edge_b = farthest_edge(cb, ca, -d);
    const Mask from_b = (edge_a.value + Float(t.face_tie) < edge_b.value) |
                        (max(edge_a.value, zero) < edge_b.value);
    const PolygonEdge ref = select(from_b, edge_b, edge_a);
    const PolygonEdge inc =
        select(from_b, opposed_edge(ca, edge_b.normal), opposed_edge(cb, edge_a.normal));
    const Vec2 d_r = select(from_b, -d, d);
    EdgePair e;
    e.normal = ref.normal;
    e.middle = (ref.from + ref.to) * half;
    const Vec2 span = (ref.to - ref.from) * half;
    e.half = sqrt(dot(span, span));
    e.incident_middle = fma(inc.from + inc.to, half, d_r);
    e.incident_half = (inc.to - inc.from) * half;
    e.flip = from_b;
    e.d = d;
    clip_edges(e, Float(t.margin), m);
    m.code =
        select(from_b, fma(inc.index, Real(16), ref.index), fma(ref.index, Real(16), inc.index));
  }
};

template <class S>
struct PolygonCircle {
  using A = PolygonPose;
  using B = CirclePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    const Float zero(Real(0)), one(Real(1));
    const PolygonCorners c = load_corners(a);
    const Vec2 d = b.p - a.p;
    PolygonEdge best = first_edge(c, Real(-1e30));
    for (int i = 0; i < kernels::kMaxVertices; ++i) {
      const Float s = dot(c.normal[i], d - c.vertex[i]);
      take_edge(best.value < s, c, i, s, best);
    }
    // Outside, the nearest point lies on the farthest edge, between its ends.
    const Vec2 along = best.to - best.from;
    const Float length2 = dot(along, along);
    const Float place = clamp(dot(along, d - best.from) / max(length2, Real(1e-20)), zero, one);
    const Vec2 out = d - fma(along, place, best.from);
    const Float d2 = dot(out, out);
    const Mask outside = (zero < best.value) & (Float(kTinyDistance2) < d2);
    const Float length = sqrt(d2);
    const Float inv = one / select(outside, length, one);
    const Vec2 n = select(outside, out * inv, best.normal);
    const Float separation = select(outside, length, best.value) - b.radius;
    m.normal = n;
    m.separation[0] = separation;
    m.point_b[0] = n * -fma(min(separation, zero), Real(0.5), b.radius);
    m.point_a[0] = fma(n, -max(separation, zero), m.point_b[0] + d);
    m.feature_x[0] = m.feature_y[0] = zero;
    m.code = zero;
    m.match_distance2 = zero;
    m.valid[0] = mask_from_bits(kAllLanes);
  }
};

// With a radius around the polygon: as if it were the circle's, but for the points.
template <class S>
struct RoundedCircle {
  using A = RoundedPose;
  using B = CirclePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants& t, const A& a, const B& b, Float axis,
                                Manifold<S, 1>& m) {
    PolygonCircle<S>::collide(t, a, {b.p, b.radius + a.radius}, axis, m);
    m.point_a[0] = fma(m.normal, a.radius, m.point_a[0]);
    m.point_b[0] = fma(m.normal, a.radius, m.point_b[0]);
  }
};

template <class S, class PoseB>
struct PlaneOutline {
  using A = PlanePose;
  using B = PoseB;
  static constexpr int kPoints = 2;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 2>& m) {
    const Vec2 n{a.normal.x, a.normal.y};
    const PolygonEdge e = opposed_edge(load_corners(b), n);
    const Float height = dot(n, b.p) - a.offset;
    const Vec2 corner[2] = {e.from, e.to};
    const Vec2 span = e.to - e.from;
    const Float half = sqrt(dot(span, span)) * Float(Real(0.5));
    m.normal = n;
    for (int i = 0; i < 2; ++i) {
      m.separation[i] = height + dot(n, corner[i]);
      Vec2 lowest = corner[i];
      if constexpr (std::is_same_v<PoseB, RoundedPose>) {
        m.separation[i] = m.separation[i] - b.radius;
        lowest = fnma(n, b.radius, lowest);
      }
      m.point_b[i] = fma(n, min(m.separation[i], Real(0)) * Float(Real(-0.5)), lowest);
      m.point_a[i] = m.point_b[i];
      m.feature_x[i] = i == 0 ? -half : half;
      m.feature_y[i] = Real(0);
      m.valid[i] = mask_from_bits(kAllLanes);
    }
    m.code = e.index;
    m.match_distance2 = match_distance2(half);
  }
};
template <class S>
using PlanePolygon = PlaneOutline<S, PolygonPose>;

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
