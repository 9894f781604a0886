// The corners of planar convex shapes and the search among their edges. Each shape's file loads its
// own.
#pragma once

#include "kernels/shape/tangent.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Counter-clockwise; normal i is that of the edge from vertex i to the next.
template <int N>
struct Corners {
  static constexpr int kCount = N;
  Vec2 vertex[N], normal[N];
};

// An edge chosen per lane: the running winner of a loop over all edges.
struct PolygonEdge {
  Vec2 normal, from, to;
  Float value, index;
};
template <int N>
MW_INLINE void take_edge(Mask better, const Corners<N>& c, int i, Float value, PolygonEdge& e) {
  e.normal = select(better, c.normal[i], e.normal);
  e.from = select(better, c.vertex[i], e.from);
  e.to = select(better, c.vertex[(i + 1) % N], e.to);
  e.value = select(better, value, e.value);
  e.index = select(better, Float(static_cast<Real>(i)), e.index);
}
template <int N>
MW_INLINE PolygonEdge first_edge(const Corners<N>& c, Float value) {
  return {c.normal[0], c.vertex[0], c.vertex[1], value, Real(0)};
}

// The separation of `other`, whose origin is d away, from the line through edge i.
template <int N, int M>
MW_INLINE Float separation_from_edge(const Corners<N>& ref, int i, const Corners<M>& other,
                                     Vec2 d) {
  const Vec2 shift = d - ref.vertex[i];
  Float nearest = dot(ref.normal[i], other.vertex[0]);
  for (int j = 1; j < M; ++j) nearest = min(dot(ref.normal[i], other.vertex[j]), nearest);
  return nearest + dot(ref.normal[i], shift);
}

// The edge of `ref` with the largest separation from `other`.
template <int N, int M>
MW_INLINE PolygonEdge farthest_edge(const Corners<N>& ref, const Corners<M>& other, Vec2 d) {
  PolygonEdge best = first_edge(ref, Real(-1e30));
  for (int i = 0; i < N; ++i) {
    const Float s = separation_from_edge(ref, i, other, d);
    take_edge(best.value < s, ref, i, s, best);
  }
  return best;
}

// The edge of `other` most opposed to n.
template <int N>
MW_INLINE PolygonEdge opposed_edge(const Corners<N>& other, Vec2 n) {
  const Float tie(Real(1e-3));
  PolygonEdge best = first_edge(other, dot(other.normal[0], n));
  for (int i = 1; i < N; ++i) {
    const Float along = dot(other.normal[i], n);
    take_edge(along + tie < best.value, other, i, along, best);
  }
  return best;
}

MW_INLINE PolygonEdge select(Mask m, const PolygonEdge& a, const PolygonEdge& b) {
  return {select(m, a.normal, b.normal), select(m, a.from, b.from), select(m, a.to, b.to),
          select(m, a.value, b.value), select(m, a.index, b.index)};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
