// Poses of shapes in registers, loaded from their rows (tables.hpp says what a row holds).
#pragma once

#include "kernels/lane/space.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct SpherePose {
  Vec3 p;
  Float radius;
};
struct BoxPose {
  Mat3 r;
  Vec3 p, half;
  Float margin;  // how far this box's bounds reach beyond it, m
};
struct CylinderPose {  // along z
  Mat3 r;
  Vec3 p;
  Float radius, half;
};
// Every lane's hull at a place of its own: its faces, for rays (collide/convex.hpp for the rest).
struct HullPose {
  Mat3 r;
  Vec3 p, half;
  Float margin;
  const Real* corners;
  alignas(64) std::int32_t at[kLanes], faces[kLanes];  // of the first face
  int most_faces;
};
struct CirclePose {
  Vec2 p;
  Float radius;
};
struct RectanglePose {
  Vec2 p;
  Rot2 q;
  Vec2 half;
};
struct PolygonPose {
  Vec2 p;
  Float radius;      // of the bounding circle about p
  const Real* base;  // vertices and normals stay in their rows
  const std::int32_t* offset;
};
struct RoundedPose : PolygonPose {};  // radius: of its rounding
template <class Vec>
struct CapsulePose {
  Vec p, axis;
  Float radius, half;  // half length without the round ends
};
struct LinkPose {  // p: its middle
  Vec2 p, axis;
  Float half, low, high, index;  // contacts from low to high along the axis
  Vec2 before, after;            // last normals at either end
};
struct PlanePose {  // origin at the point of the plane nearest to the world's origin
  Vec3 normal, tangent;
  Float offset;
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, SpherePose& s) {
  load_rows4(base, o, s.p.x, s.p.y, s.p.z, s.radius);
}
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, BoxPose& b) {
  load_rows8(base, o, b.r.x.x, b.r.x.y, b.r.x.z, b.p.x, b.r.y.x, b.r.y.y, b.r.y.z, b.p.y);
  load_rows8(base + 8, o, b.r.z.x, b.r.z.y, b.r.z.z, b.p.z, b.half.x, b.half.y, b.half.z, b.margin);
}
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, CylinderPose& c) {
  BoxPose box;
  load_pose(base, o, box);
  c = {box.r, box.p, box.half.x, box.half.z};
}
// `hulls`: where the corners are; nullptr: behind the row.
MW_INLINE void load_hull(const Real* base, const std::int32_t* o, const Real* hulls, HullPose& h) {
  BoxPose box;
  load_pose(base, o, box);
  // The dummy has no size.
  const Float least(Real(1e-12));
  h.r = box.r, h.p = box.p, h.margin = box.margin;
  h.half = {max(box.half.x, least), max(box.half.y, least), max(box.half.z, least)};
  h.corners = hulls ? hulls : base;
  h.most_faces = 0;
  for (int l = 0; l < kLanes; ++l) {
    const Real* row = base + o[l] + 16;
    h.at[l] = (hulls ? 4 * static_cast<std::int32_t>(row[0]) : o[l] + 20) +
              4 * static_cast<std::int32_t>(row[1]);
    h.faces[l] = static_cast<std::int32_t>(row[2]);
    h.most_faces = h.faces[l] > h.most_faces ? h.faces[l] : h.most_faces;
  }
}
MW_INLINE Vec3 inverse_of(Vec3 half) {
  const Float one(Real(1));
  return {one / half.x, one / half.y, one / half.z};
}

// Row k of each lane's corners, `width` quads wide; a lane that has fewer than that repeats its
// last.
MW_INLINE void corner_offsets(const std::int32_t* first, const std::int32_t* count, int k,
                              int width, std::int32_t* out) {
  for (int l = 0; l < kLanes; ++l) {
    const int last = count[l] > 0 ? count[l] - 1 : 0;
    out[l] = first[l] + 4 * width * (k < last ? k : last);
  }
}

// Face i of each lane's hull: unit normal in world axes, how far the hull reaches along it from p.
struct HullFace {
  Vec3 normal;
  Float reach;
};
MW_INLINE HullFace hull_face(const HullPose& h, Vec3 inverse_half, int i) {
  alignas(64) std::int32_t o[kLanes];
  corner_offsets(h.at, h.faces, i, 2, o);
  Vec3 m;
  Float c;
  load_rows4(h.corners, o, m.x, m.y, m.z, c);
  const Vec3 local{m.x * inverse_half.x, m.y * inverse_half.y, m.z * inverse_half.z};
  // The dummy's has no length.
  const Float inv = Float(Real(1)) / sqrt(max(dot(local, local), Real(1e-30)));
  return {mul(h.r, local * inv), c * inv};
}

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, CirclePose& c) {
  Float unused;
  load_rows4(base, o, c.p.x, c.p.y, c.radius, unused);
}
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, RectanglePose& r) {
  Float unused0, unused1;
  load_rows4(base, o, r.p.x, r.p.y, r.q.c, r.q.s);
  load_rows4(base + 4, o, r.half.x, r.half.y, unused0, unused1);
}
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, PolygonPose& p) {
  Float unused;
  load_rows4(base, o, p.p.x, p.p.y, unused, p.radius);
  p.base = base;
  p.offset = o;
}
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, PlanePose& p) {
  Float unused;
  load_rows8(base, o, p.normal.x, p.normal.y, p.normal.z, p.offset, p.tangent.x, p.tangent.y,
             p.tangent.z, unused);
}

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, CapsulePose<Vec3>& c) {
  load_rows8(base, o, c.p.x, c.p.y, c.p.z, c.radius, c.axis.x, c.axis.y, c.axis.z, c.half);
}
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, CapsulePose<Vec2>& c) {
  Float unused;
  load_rows4(base, o, c.p.x, c.p.y, unused, c.radius);
  load_rows4(base + 4, o, c.axis.x, c.axis.y, unused, c.half);
}

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, LinkPose& l) {
  load_rows4(base, o, l.p.x, l.p.y, l.axis.x, l.axis.y);
  load_rows4(base + 4, o, l.half, l.low, l.high, l.index);
  load_rows4(base + 8, o, l.before.x, l.before.y, l.after.x, l.after.y);
}

// Two vertices (or with k >= kMaxVertices normals) of the polygons of the lanes.
MW_INLINE void load_vertex_pair(const PolygonPose& p, int k, Vec2& a, Vec2& b) {
  load_rows4(p.base + 4 + 2 * k, p.offset, a.x, a.y, b.x, b.y);
}

// Any unit vector perpendicular to n, continuous but for n.z = -1 (Duff et al. 2017).
MW_INLINE Vec3 any_tangent(Vec3 n) {
  const Float one(Real(1));
  const Float sign = copysign(one, n.z);
  const Float a = -(one / (sign + n.z));
  const Float b = n.x * n.y * a;
  return {fma(sign * n.x * n.x, a, one), sign * b, -(sign * n.x)};
}

// A unit vector across a unit vector.
MW_INLINE Vec3 across(Vec3 a) { return any_tangent(a); }
MW_INLINE Vec2 across(Vec2 a) { return {-a.y, a.x}; }

// A unit tangent to n that follows `axis` where it can, so that it turns with the body.
MW_INLINE Vec3 tangent_along(Vec3 axis, Vec3 n) {
  const Vec3 t = fnma(n, dot(n, axis), axis);
  const Float l2 = dot(t, t);
  const Mask usable = Float(Real(0.01)) < l2;
  return select(usable, t * (Float(Real(1)) / sqrt(select(usable, l2, Float(Real(1))))),
                any_tangent(n));
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
