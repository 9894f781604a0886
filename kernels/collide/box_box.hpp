// Box against box, second half: the manifold for a known separating axis. Face axes: the incident
// face (of the other box, most opposed) is clipped against the reference face (box_faces.hpp). Edge
// axes: one point and its guards (box_edges.hpp).
#pragma once

#include "kernels/collide/box_edges.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct BoxBox {
  using A = BoxPose;
  using B = BoxPose;
  static constexpr int kPoints = 4;
  static MW_INLINE void collide(const Constants& t, const A& a, const B& b, Float axis,
                                Manifold<S, 4>& m) {
    const Float zero(Real(0)), half(Real(0.5)), two(Real(2)), five(Real(5));
    const Vec3 d = b.p - a.p;
    const Mask edge = five < axis;
    Mask from_b = (two < axis) & !edge;
    Float face_axis = min(select(from_b, axis - Float(Real(3)), axis), two);
    Vec3 towards = d;
    EdgeContact touch{};
    if (any(edge)) {
      touch = edge_contact(a, b, d, axis);
      from_b = from_b | (edge & touch.face_of_b);
      face_axis = select(edge, touch.face, face_axis);
      towards = select(edge, touch.normal, d);
    }
    // Reference and incident box; d_r from the reference to the incident centre.
    const BoxPose ref = select(from_b, b, a), inc = select(from_b, a, b);
    const Vec3 d_r = select(from_b, -d, d);
    const FaceFrame f = face_frame(ref, face_axis, select(from_b, -towards, towards));
    const BoxFace other = opposed_face(inc, f.n);
    const Vec3 c = d_r + other.centre;
    ClipPoints clipped;
    // A little wider than the face, so that corners on its very edge are inside whatever rounding
    // says.
    const Float slack = Real(1) + kEdgeSlack;
    clip_face({dot(f.u, c), dot(f.v, c), dot(f.n, c) - f.height},
              {dot(f.u, other.edge1), dot(f.v, other.edge1), dot(f.n, other.edge1)},
              {dot(f.u, other.edge2), dot(f.v, other.edge2), dot(f.n, other.edge2)},
              f.half_u * slack, f.half_v * slack, clipped);
    KeptPoints kept;
    const Float extent2 = min(fma(f.half_u, f.half_u, f.half_v * f.half_v),
                              dot(other.edge1, other.edge1) + dot(other.edge2, other.edge2));
    keep_four(clipped, Float(t.margin), Float(t.margin * kLevel), extent2, kept);
    m.normal = select(from_b, -f.n, f.n);
    m.tangent = f.u;
    for (int i = 0; i < 4; ++i) {
      const Float z = min(kept.z[i], Real(1e3));
      const Float x = kept.x[i], y = kept.y[i];
      const Vec3 base = fma(f.v, y, f.u * x);
      const Vec3 on_ref = fma(f.n, fma(min(z, zero), half, f.height), base);
      const Vec3 on_inc = fma(f.n, max(z, z * half) + f.height, base) - d_r;
      m.point_a[i] = select(from_b, on_inc, on_ref);
      m.point_b[i] = select(from_b, on_ref, on_inc);
      m.separation[i] = z;
      m.feature_x[i] = x;
      m.feature_y[i] = y;
      m.valid[i] = kept.valid[i];
      m.guard[i] = kept.guard[i];
    }
    // Points, and the friction's directions, are told apart by A's face even if B has the reference
    // face, so that impulses are carried over when it changes.
    const Mask by_b = from_b & !edge;
    if (any(by_b)) {
      const Float one(Real(1));
      const Vec3 u = other.edge1 * (one / other.half1), v = other.edge2 * (one / other.half2);
      const Vec3 tangent = fnma(f.n, dot(f.n, u), u);
      const Float length = sqrt(select(by_b, dot(tangent, tangent), one));
      m.tangent = select(by_b, tangent * (one / length), m.tangent);
      put_places(u, v, by_b, m);
    }
    m.code =
        select(from_b, fma(other.axis, Real(8), face_axis), fma(face_axis, Real(8), other.axis));
    m.match_distance2 = match_distance2(min(f.half_u, f.half_v));
    if (any(edge)) put_edge_contact(touch, axis, d, from_b, f, kept, extent2, edge, m);
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
