// Links against circles, rectangles, polygons and capsules. A link is one segment of a terrain:
// solid behind, and smooth where it meets its neighbours. A shape that slides from link to link
// must not catch on the vertex between them, so a contact's normal is only ever one that the
// terrain's surface has there: the link's own, or at a vertex that sticks out one between the
// link's and the neighbour's. Separating axes are sought among those alone.
//
// Where the next link bends up, the free space in front of it lies in front of this link's line
// too. So the link reaches as far along its line as that neighbour does, and stops a fast body
// before the corner is passed. A shape whose origin is behind the line is not touched.
#pragma once

#include "kernels/collide/planar_capsule.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Sine by which a normal may leave the range at a vertex that sticks out: bodies at rest on the
// neighbour lean a little.
inline constexpr Real kNormalSlack = Real(1e-3);

// Whether the terrain's surface has this normal at the link or at its ends.
MW_INLINE Mask has_normal(const LinkPose& link, Vec2 n) {
  const Float zero(Real(0)), most(kNormalSlack);
  const Vec2 up = across(link.axis);
  // Up to the neighbour's normal, clockwise after the link and counter-clockwise before it.
  const Float slack_after = min(cross(link.after, up), most);
  const Float slack_before = min(cross(up, link.before), most);
  const Float along = dot(link.axis, n);
  const Mask ahead = (-slack_after < cross(link.after, n)) & (zero < dot(n, up + link.after));
  const Mask back = (cross(link.before, n) < slack_before) & (zero < dot(n, up + link.before));
  return ((zero <= along) & ahead) | ((along < zero) & back);
}

// The report tells the links of a terrain apart; 256 features of each.
MW_INLINE Float link_code(const LinkPose& link, Float feature) {
  return fma(link.index, Real(256), feature);
}

template <class S>
struct LinkCircle {
  using A = LinkPose;
  using B = CirclePose;
  static constexpr int kPoints = 1;
  static MW_INLINE void collide(const Constants&, const A& a, const B& b, Float,
                                Manifold<S, 1>& m) {
    const Float zero(Real(0)), one(Real(1));
    const Vec2 d = b.p - a.p, up = across(a.axis);
    const Float place = dot(a.axis, d), height = dot(up, d);
    const Float nearest = clamp(place, a.low, a.high);
    const Mask above = nearest == place;
    const Vec2 way = fnma(a.axis, nearest, d);
    const Float way2 = dot(way, way);
    const Mask apart = Float(kTinyDistance2) < way2;
    const Float distance = select(above, height, sqrt(way2));
    m.normal = select(above | !apart, up, way * (one / sqrt(select(apart, way2, one))));
    put_point(m, 0, a.axis * nearest, zero, distance - b.radius, d);
    m.feature_x[0] = m.feature_y[0] = zero;
    m.code = link_code(a, zero);
    m.match_distance2 = zero;
    m.valid[0] = (zero <= height) & (above | has_normal(a, m.normal));
  }
};

template <class S, class PoseB>
struct LinkEdges {
  using A = LinkPose;
  using B = PoseB;
  static constexpr int kPoints = 2;
  static MW_INLINE void collide(const Constants& t, const A& a, const B& b, Float,
                                Manifold<S, 2>& m) {
    const Float zero(Real(0)), tie(t.face_tie);
    const Vec2 d = b.p - a.p, up = across(a.axis), end = a.axis * a.half;
    const Corners<2> ca{{-end, end}, {-up, up}};
    const auto cb = load_corners(b);
    const Float radius = radius_of(b);

    const Float height = separation_from_edge(ca, 1, cb, d);
    const PolygonEdge front{up, a.axis * a.high, a.axis * a.low, height, zero};
    const PolygonEdge surface{up, end, -end, height, zero};
    PolygonEdge edge_b = first_edge(cb, Real(-1e30));
    for (int i = 0; i < cb.kCount; ++i) {
      const Float s = separation_from_edge(cb, i, ca, -d);
      take_edge(has_normal(a, -cb.normal[i]) & (edge_b.value < s), cb, i, s, edge_b);
    }
    const Mask from_b = height + tie < edge_b.value;
    const PolygonEdge ref = select(from_b, edge_b, front);
    const PolygonEdge inc = select(from_b, surface, opposed_edge(cb, up));
    const RoundEdgePair edges = edge_pair(ref, inc, from_b, d, zero, radius);
    const Float nearest = clip_edges(edges, Float(t.margin), m);
    const Mask over = nearest < Float(Real(1e5));
    m.valid[0] = m.valid[0] & over, m.valid[1] = m.valid[1] & over;
    m.code = select(from_b, ref.index, inc.index);
    if constexpr (std::is_same_v<PoseB, CapsulePose<Vec2>> || std::is_same_v<PoseB, RoundedPose>) {
      const NearestCorner near = nearest_corner_to(b, ca, cb, d);
      const Mask corner = (zero < ref.value) & (ref.value - radius + tie < nearest) &
                          has_normal(a, near.way * (Float(Real(1)) / sqrt(near.way2)));
      put_corner(corner, near, zero, radius, d, m);
    }
    m.code = link_code(a, m.code);
    // Features are places on B, which comes along while link follows link.
    const Float half_b = sqrt(dot(edges.incident_half, edges.incident_half));
    m.match_distance2 = match_distance2(select(from_b, edges.half, half_b));
    const Mask in_front = zero <= dot(up, d);
    for (int i = 0; i < 2; ++i) {
      m.feature_x[i] = dot(a.axis, m.point_b[i]);
      m.valid[i] = m.valid[i] & in_front;
    }
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
