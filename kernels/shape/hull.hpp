// Convex hulls: pose row, bounds, rays, distance, and as convex shapes. Every lane has its hull at
// a place of its own.
#pragma once

#include "kernels/shape/box.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using HullRow = kernels::HullRow<Real>;
// Number `offset` of a row on.
MW_INLINE const HullRow& hull_row(const Real* base, std::int32_t offset) {
  return *reinterpret_cast<const HullRow*>(base + offset);
}

struct HullPose {
  static constexpr auto kKind = kernels::ShapeKind::hull;
  Mat3 r;
  Vec3 p, half;
  Float margin;
  HullFaces faces;

  static MW_INLINE BoundsOf<Vec3> put(const SpatialPlacement& s);
  static void load(const Real* hulls, const Real* base, const std::int32_t* o, ConvexShape& s);
  static MW_INLINE Extent extent(const ConvexShape& s, Vec3 n) { return extent_of_vertices(s, n); }
  static MW_INLINE Vec3 support(const ConvexShape& s, Vec3 n) { return support_of_vertices(s, n); }
  static void feature(const ConvexShape& s, Vec3 n, Real tie, Feature& f);
};

// `hulls`: where the corners are; nullptr: behind the row, as those of a fixed shape.
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, const Real* hulls, HullPose& h) {
  BoxPose box;
  load_pose(base, o, box);
  // The dummy has no size.
  const Float least(Real(1e-12));
  h.r = box.r, h.p = box.p, h.margin = box.margin;
  h.half = {max(box.half.x, least), max(box.half.y, least), max(box.half.z, least)};
  h.faces.corners = hulls ? hulls : base;
  h.faces.most = 0;
  for (int l = 0; l < kLanes; ++l) {
    const HullRow& row = hull_row(base, o[l]);
    const std::int32_t corners =
        hulls ? 4 * static_cast<std::int32_t>(row.at) : o[l] + kernels::row_size<kernels::HullRow>;
    h.faces.first[l] = corners + 4 * static_cast<std::int32_t>(row.vertices);
    h.faces.count[l] = static_cast<std::int32_t>(row.faces);
    h.faces.most = h.faces.count[l] > h.faces.most ? h.faces.count[l] : h.faces.most;
  }
}
MW_INLINE BoundsOf<Vec3> HullPose::put(const SpatialPlacement& s) {
  put_box_row(s);
  const auto& c = s.collider;
  store_rows4(s.rows + kernels::row_size<kernels::BoxRow>, s.offset, static_cast<Real>(c.hull),
              static_cast<Real>(c.vertex_count), static_cast<Real>(c.face_count), Real(0));
  return box_bounds(s);
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
MW_INLINE HullFace hull_face(const HullFaces& faces, const Mat3& r, Vec3 inverse_half, int i) {
  alignas(64) std::int32_t o[kLanes];
  corner_offsets(faces.first, faces.count, i, 2, o);
  Vec3 m;
  Float c;
  load_rows4(faces.corners, o, m.x, m.y, m.z, c);
  const Vec3 local{m.x * inverse_half.x, m.y * inverse_half.y, m.z * inverse_half.z};
  // The dummy's has no length.
  const Float inv = Float(Real(1)) / sqrt(max(dot(local, local), Real(1e-30)));
  return {mul(r, local * inv), c * inv};
}

MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const HullPose& h) {
  const Vec3 from = ray.from - h.p, inverse = inverse_of(h.half);
  Clip clip;
  Vec3 normal = -ray.way;
  for (int i = 0; i < h.faces.most; ++i) {
    const HullFace face = hull_face(h.faces, h.r, inverse, i);
    const Mask last = clip.add(dot(face.normal, from) - face.reach, -dot(face.normal, ray.way));
    normal = select(last, face.normal, normal);
  }
  return clipped(ray, clip, normal);
}

// ---- as a convex shape -------------------------------------------------------------------------

MW_INLINE Vec3 load_hull_corner(const ConvexShape& s, const std::int32_t* o) {
  Vec3 u;
  Float unused;
  load_rows4(s.faces.corners, o, u.x, u.y, u.z, unused);
  return mul(s.r, {u.x * s.half.x, u.y * s.half.y, u.z * s.half.z});
}

MW_INLINE int max_of(const std::int32_t* count) {
  int out = 0;
  for (int l = 0; l < kLanes; ++l) out = count[l] > out ? count[l] : out;
  return out;
}

inline void load_hull_vertices(const Real* base, const std::int32_t* offset, ConvexShape& s) {
  alignas(64) std::int32_t first[kLanes], count[kLanes], o[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    count[l] = static_cast<std::int32_t>(hull_row(base, offset[l]).vertices);
    first[l] = s.faces.first[l] - 4 * count[l];
  }
  s.vertices = max_of(count);
  for (int i = 0; i < s.vertices; ++i) {
    corner_offsets(first, count, i, 1, o);
    s.vertex[i] = load_hull_corner(s, o);
  }
}

inline void HullPose::load(const Real* hulls, const Real* base, const std::int32_t* o,
                           ConvexShape& s) {
  HullPose pose;
  load_pose(base, o, hulls, pose);
  s.p = pose.p, s.r = pose.r, s.half = pose.half, s.margin = pose.margin, s.faces = pose.faces;
  load_hull_vertices(base, o, s);
}

inline void HullPose::feature(const ConvexShape& s, Vec3 n, Real tie, Feature& f) {
  const HullFaces& faces = s.faces;
  const Float one(Real(1));
  const Vec3 inverse = inverse_of(s.half);
  Float best = Real(-2), index = Real(0);
  f.normal = n;
  for (int i = 0; i < faces.most; ++i) {
    const Vec3 normal = hull_face(faces, s.r, inverse, i).normal;
    const Float along = dot(normal, n);
    const Mask better = best + Float(tie) < along;
    best = select(better, along, best);
    f.normal = select(better, normal, f.normal);
    index = select(better, Float(static_cast<Real>(i)), index);
  }
  f.code = index;
  f.face = mask_from_bits(kAllLanes);
  alignas(64) std::int32_t first[kLanes], count[kLanes], o[kLanes];
  alignas(64) Real chosen[kLanes];
  index.store(chosen);
  for (int l = 0; l < kLanes; ++l) {
    const Real* row = faces.corners + faces.first[l] + 8 * static_cast<int>(chosen[l]);
    count[l] = faces.count[l] > 0 ? static_cast<int>(row[5]) : 0;
    first[l] = faces.first[l] + 8 * faces.count[l] +
               (faces.count[l] > 0 ? 4 * static_cast<int>(row[4]) : 0);
  }
  f.count = max_of(count);
  for (int i = 0; i < f.count; ++i) {
    corner_offsets(first, count, i, 1, o);
    f.corner[i] = load_hull_corner(s, o);
  }
  const Vec3 edge = f.corner[1] - f.corner[0];
  const Float l2 = dot(edge, edge);
  const Mask real = Float(Real(0)) < l2;
  f.along = select(real, edge * (one / sqrt(select(real, l2, one))), s.r.x);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
