// Rectangle, polygon, rounded polygon or capsule against capsule in the plane, and rounded polygons
// against each other: all of them convex outlines of edges with a radius. Edge against edge along
// the best separating axis, as for polygons; but where two corners are nearest, one point on the
// line between them, since round ends show there.
#pragma once

#include "kernels/collide/capsule_pairs.hpp"
#include "kernels/collide/segments.hpp"
#include "kernels/shape/shapes.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// The corner of A nearest to the capsule's axis, and the shortest way from it to the axis.
struct NearestCorner {
  Vec2 corner, way;
  Float way2, index;
};
template <int N>
MW_INLINE NearestCorner nearest_corner(const Corners<N>& a, const CapsulePose<Vec2>& b, Vec2 d) {
  NearestCorner best{a.vertex[0], d, Real(1e30), Real(0)};
  for (int i = 0; i < N; ++i) {
    const Vec2 from = d - a.vertex[i];
    const Vec2 way = fma(b.axis, clamp(-dot(b.axis, from), -b.half, b.half), from);
    const Float way2 = dot(way, way);
    const Mask nearer = way2 < best.way2;
    best.corner = select(nearer, a.vertex[i], best.corner);
    best.way = select(nearer, way, best.way);
    best.way2 = select(nearer, way2, best.way2);
    best.index = select(nearer, Float(static_cast<Real>(i)), best.index);
  }
  return best;
}

// The same for two outlines' corners. Where a corner and an edge are nearest, no corner is asked
// for.
template <int N, int M>
MW_INLINE NearestCorner nearest_corner(const Corners<N>& a, const Corners<M>& b, Vec2 d) {
  NearestCorner best{a.vertex[0], d, Real(1e30), Real(0)};
  for (int i = 0; i < N; ++i) {
    const Vec2 from = d - a.vertex[i];
    for (int j = 0; j < M; ++j) {
      const Vec2 way = from + b.vertex[j];
      const Float way2 = dot(way, way);
      const Mask nearer = way2 < best.way2;
      best.corner = select(nearer, a.vertex[i], best.corner);
      best.way = select(nearer, way, best.way);
      best.way2 = select(nearer, way2, best.way2);
      best.index = select(nearer, Float(static_cast<Real>(i)), best.index);
    }
  }
  return best;
}
template <class PoseB, int N, int M>
MW_INLINE NearestCorner nearest_corner_to(const PoseB& b, const Corners<N>& a, const Corners<M>& cb,
                                          Vec2 d) {
  if constexpr (std::is_same_v<PoseB, CapsulePose<Vec2>>) {
    return nearest_corner(a, b, d);
  } else {
    return nearest_corner(a, cb, d);
  }
}

// Puts the one point between A's corner and the capsule into the lanes of `use`.
template <class S>
MW_INLINE void put_corner(Mask use, const NearestCorner& near, Float radius_a, Float radius_b,
                          Vec2 d, Manifold<S, 2>& m) {
  const Float zero(Real(0)), one(Real(1)), corners(Real(128));
  const Float distance = sqrt(select(use, near.way2, one));
  Manifold<S, 2> corner;
  corner.normal = near.way * (one / distance);
  put_point(corner, 0, near.corner, radius_a, distance - radius_a - radius_b, d);
  m.normal = select(use, corner.normal, m.normal);
  m.point_a[0] = select(use, corner.point_a[0], m.point_a[0]);
  m.point_b[0] = select(use, corner.point_b[0], m.point_b[0]);
  m.separation[0] = select(use, corner.separation[0], m.separation[0]);
  m.feature_x[0] = select(use, zero, m.feature_x[0]);
  m.valid[0] = m.valid[0] | use;
  m.valid[1] = m.valid[1] & !use;
  m.code = select(use, near.index + corners, m.code);
}

// The edges of a capsule's outline against another's: ref is the one with the larger separation.
MW_INLINE RoundEdgePair edge_pair(const PolygonEdge& ref, const PolygonEdge& inc, Mask from_b,
                                  Vec2 d, Float radius_a, Float radius_b) {
  const Float half(Real(0.5));
  RoundEdgePair e;
  e.normal = ref.normal;
  e.middle = (ref.from + ref.to) * half;
  const Vec2 span = (ref.to - ref.from) * half;
  e.half = sqrt(dot(span, span));
  e.incident_middle = fma(inc.from + inc.to, half, select(from_b, -d, d));
  e.incident_half = (inc.to - inc.from) * half;
  e.flip = from_b;
  e.d = d;
  e.radius = select(from_b, radius_b, radius_a);
  e.incident_radius = select(from_b, radius_a, radius_b);
  return e;
}

template <class S, class PoseA, class PoseB>
struct RoundEdges {
  using A = PoseA;
  using B = PoseB;
  static constexpr int kPoints = 2;
  static MW_INLINE void collide(const Constants& t, const A& a, const B& b, Float,
                                Manifold<S, 2>& m) {
    const Float zero(Real(0)), tie(t.face_tie);
    const auto ca = load_corners(a);
    const auto cb = load_corners(b);
    const Float radius_a = radius_of(a), radius_b = radius_of(b), radii = radius_a + radius_b;
    const Vec2 d = b.p - a.p;
    const PolygonEdge edge_a = farthest_edge(ca, cb, d), edge_b = farthest_edge(cb, ca, -d);
    const Mask from_b = edge_a.value + tie < edge_b.value;
    const PolygonEdge ref = select(from_b, edge_b, edge_a);
    const PolygonEdge inc =
        select(from_b, opposed_edge(ca, edge_b.normal), opposed_edge(cb, edge_a.normal));
    const Float nearest =
        clip_edges(edge_pair(ref, inc, from_b, d, radius_a, radius_b), Float(t.margin), m);
    m.code =
        select(from_b, fma(inc.index, Real(16), ref.index), fma(ref.index, Real(16), inc.index));
    // Faces that do not lie above one another are nearest at corners, unless the axes cross.
    const Mask corner = (zero < ref.value) & (ref.value - radii + tie < nearest);
    put_corner(corner, nearest_corner_to(b, ca, cb, d), radius_a, radius_b, d, m);
  }
};
template <class S, class PoseA>
using EdgesCapsule = RoundEdges<S, PoseA, CapsulePose<Vec2>>;

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
