// Convex polygons, rounded or not: pose row, bounds, rays, distance, corners.
#pragma once

#include "kernels/shape/corners.hpp"
#include "kernels/shape/placement.hpp"
#include "kernels/shape/ray.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using PolygonCorners = Corners<kernels::kMaxVertices>;

struct PolygonPose {
  static constexpr auto kKind = kernels::ShapeKind::polygon;
  Vec2 p;
  Float radius;      // of the bounding circle about p
  const Real* base;  // vertices and normals stay in their rows
  const std::int32_t* offset;

  static MW_INLINE BoundsOf<Vec2> put(const PlanarPlacement& s);
};
struct RoundedPose : PolygonPose {  // radius: of its rounding
  static constexpr auto kKind = kernels::ShapeKind::rounded;

  static MW_INLINE BoundsOf<Vec2> put(const PlanarPlacement& s);
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, PolygonPose& p) {
  Float unused;
  load_rows4(base, o, p.p.x, p.p.y, unused, p.radius);
  p.base = base;
  p.offset = o;
}

// Two vertices (or with k >= kMaxVertices normals) of the polygons of the lanes.
MW_INLINE void load_vertex_pair(const PolygonPose& p, int k, Vec2& a, Vec2& b) {
  load_rows4(p.base + 4 + 2 * k, p.offset, a.x, a.y, b.x, b.y);
}

// `reach`: of the bounds beyond the vertices.
MW_INLINE BoundsOf<Vec2> put_polygon(const PlanarPlacement& s, Float reach) {
  store_rows4(s.rows, s.offset, s.p.x, s.p.y, static_cast<Real>(s.collider.vertex_count),
              s.constants.radius);
  Vec2 low{Real(1e30), Real(1e30)}, high{Real(-1e30), Real(-1e30)};
  for (int i = 0; i < kernels::kMaxVertices; i += 2) {
    Vec2 a[2], n[2];
    for (int k = 0; k < 2; ++k) {
      const LaneNumber* vertex = s.polygon->vertices + 2 * (i + k);
      const LaneNumber* normal = s.polygon->normals + 2 * (i + k);
      a[k] = rotate(s.r, {vertex[0], vertex[1]});
      n[k] = rotate(s.r, {normal[0], normal[1]});
      low = {min(low.x, a[k].x), min(low.y, a[k].y)};
      high = {max(high.x, a[k].x), max(high.y, a[k].y)};
    }
    store_rows4(s.rows + 4 + 2 * i, s.offset, a[0].x, a[0].y, a[1].x, a[1].y);
    store_rows4(s.rows + 4 + 2 * kernels::kMaxVertices + 2 * i, s.offset, n[0].x, n[0].y, n[1].x,
                n[1].y);
  }
  const Float half(Real(0.5));
  return {s.p + (low + high) * half,
          {fma(high.x - low.x, half, reach), fma(high.y - low.y, half, reach)}};
}
MW_INLINE BoundsOf<Vec2> PolygonPose::put(const PlanarPlacement& s) {
  return put_polygon(s, s.margin);
}
MW_INLINE BoundsOf<Vec2> RoundedPose::put(const PlanarPlacement& s) {
  return put_polygon(s, s.margin + Float(s.constants.radius));
}

// Unused places of a polygon repeat vertex and normal 0, which never win a strict comparison
// against the first.
MW_INLINE PolygonCorners load_corners(const PolygonPose& p) {
  PolygonCorners c;
  for (int i = 0; i < kernels::kMaxVertices; i += 2) {
    load_vertex_pair(p, i, c.vertex[i], c.vertex[i + 1]);
    load_vertex_pair(p, kernels::kMaxVertices + i, c.normal[i], c.normal[i + 1]);
  }
  return c;
}
MW_INLINE Float radius_of(const PolygonPose&) { return Real(0); }
MW_INLINE Float radius_of(const RoundedPose& p) { return p.radius; }

MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const PolygonPose& p) {
  const Vec2 place = ray.from - p.p;
  Clip clip;
  Vec2 normal = -ray.way;
  for (int i = 0; i < kernels::kMaxVertices; i += 2) {
    Vec2 vertex[2], out[2];
    load_vertex_pair(p, i, vertex[0], vertex[1]);
    load_vertex_pair(p, i + kernels::kMaxVertices, out[0], out[1]);
    for (int k = 0; k < 2; ++k) {
      const Mask last = clip.add(dot(out[k], place - vertex[k]), -dot(out[k], ray.way));
      normal = select(last, out[k], normal);
    }
  }
  return clipped(ray, clip, normal);
}

// Round corners, and edges moved out between them.
MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const RoundedPose& p) {
  const Float zero(Real(0)), one(Real(1));
  const PolygonCorners c = load_corners(p);
  const Vec2 from = ray.from - p.p;
  RayHit<Vec2> best{Float(kRayFar), -ray.way, zero < zero};
  Float height = Real(-1e30), nearest2 = Real(1e30);
  for (int i = 0; i < kernels::kMaxVertices; ++i) {
    best = nearer(best, cast_round(ray, c.vertex[i] - from, p.radius));
    const Vec2 edge = c.vertex[(i + 1) % kernels::kMaxVertices] - c.vertex[i];
    const Vec2 place = from - c.vertex[i];
    const Float above = dot(c.normal[i], place), fall = -dot(c.normal[i], ray.way);
    const Mask toward = zero < fall;
    RayHit<Vec2> side;
    side.distance = (above - p.radius) / select(toward, fall, one);
    side.normal = c.normal[i];
    const Float along = dot(edge, fma(ray.way, side.distance, place)), length2 = dot(edge, edge);
    side.hit =
        toward & (zero <= side.distance) & (zero <= along) & (along <= length2) & (zero < length2);
    best = nearer(best, side);
    height = max(above, height);
    const Vec2 out =
        fnma(edge, clamp(dot(edge, place) / max(length2, Real(1e-20)), zero, one), place);
    nearest2 = min(dot(out, out), nearest2);
  }
  return begin_inside(ray, (height <= zero) | (nearest2 <= p.radius * p.radius), best);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
