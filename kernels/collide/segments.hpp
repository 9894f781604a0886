// Planar manifolds: an incident edge clipped against a reference edge. Shared by rectangles,
// polygons and capsules.
#pragma once

#include <type_traits>

#include "kernels/collide/plane_box.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Reference edge: its middle from the reference shape's origin, outward normal, half length.
// Incident edge: its middle and half vector, from the same origin. flip: the reference is B.
struct EdgePair {
  Vec2 normal, middle;
  Float half;
  Vec2 incident_middle, incident_half;
  Mask flip;
  Vec2 d;  // B's origin from A's
};

// The same with a radius around each edge.
struct RoundEdgePair : EdgePair {
  Float radius, incident_radius;
};

// The part of the incident edge over the reference edge, at most two points. Returns the nearer
// one's separation, or out of reach if no part is over it. What is sharp touches beside the
// reference edge only in overlap.
template <class S, class Edges>
MW_INLINE Float clip_edges(const Edges& e, Float margin, Manifold<S, 2>& m) {
  constexpr bool kRound = std::is_same_v<Edges, RoundEdgePair>;
  const Float one(Real(1)), half(Real(0.5));
  const Vec2 along{-e.normal.y, e.normal.x};
  const Vec2 c = e.incident_middle - e.middle;
  const Float x = dot(along, c), z = dot(e.normal, c);
  const Float dx = dot(along, e.incident_half), dz = dot(e.normal, e.incident_half);
  const Float size = max(abs(dx), abs(dz));
  const Float least = size * (sizeof(Real) == 4 ? Real(1e-6) : Real(1e-12));
  const Float inv = one / copysign(max(abs(dx), max(least, Real(1e-30))), dx);
  const Float middle = -(x * inv), span = abs(e.half * inv);
  Float enter = max(-one, middle - span), leave = min(one, middle + span);
  // Beside the reference edge altogether: the deepest end of the incident edge is what touches.
  const Mask beside = leave < enter;
  const Float deepest = copysign(one, -dz);
  enter = select(beside, deepest, enter);
  leave = select(beside, deepest, leave);
  const Float at[2] = {enter, leave};
  Float separation[2];
  for (int i = 0; i < 2; ++i) {
    separation[i] = fma(dz, at[i], z);
    if constexpr (kRound) separation[i] = separation[i] - (e.radius + e.incident_radius);
  }
  // The far end may touch within the step if it is no more than half of its edge away; whether it
  // does, its speed tells (measure_approach).
  const Float limit = max(margin, size) + max(min(separation[0], separation[1]), Real(0));
  m.normal = select(e.flip, -e.normal, e.normal);
  const Vec2 from_a = select(e.flip, -along, along);
  for (int i = 0; i < 2; ++i) {
    const Float place = fma(dx, at[i], x), gap = separation[i];
    const Vec2 base = fma(along, place, e.middle);
    // Both from the reference's origin; the other origin is d away.
    Float to_ref = min(gap, Real(0)) * half, to_inc = max(gap, gap * half);
    if constexpr (kRound) to_ref = to_ref + e.radius, to_inc = to_inc + e.radius;
    const Vec2 on_ref = fma(e.normal, to_ref, base);
    const Vec2 on_inc = fma(e.normal, to_inc, base);
    m.point_a[i] = select(e.flip, on_inc + e.d, on_ref);
    m.point_b[i] = select(e.flip, on_ref, on_inc - e.d);
    m.separation[i] = separation[i];
    // The same whichever shape has the reference edge, so that impulses are carried over when it
    // changes.
    m.feature_x[i] = dot(from_a, m.point_a[i]);
    m.feature_y[i] = Real(0);
    m.valid[i] = separation[i] < limit;
    if constexpr (!kRound) m.valid[i] = m.valid[i] & (!beside | (separation[i] < Float(Real(0))));
  }
  // One point of contact when the two ends coincide.
  m.valid[1] = m.valid[1] & (enter < leave);
  m.match_distance2 = match_distance2(e.half);
  return select(beside, Float(Real(1e6)), min(separation[0], separation[1]));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
