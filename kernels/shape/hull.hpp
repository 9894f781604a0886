// Convex hulls: pose row, bounds, rays, distance, and as convex shapes. Every lane has its hull at
// a place of its own.
#pragma once

#include "kernels/shape/box.hpp"
#include "kernels/shape/farthest_corner.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct HullPose {
  static constexpr auto kKind = kernels::ShapeKind::hull;
  Mat3 r;
  Vec3 p, half;
  Float margin;
  HullTables tables;

  static MW_INLINE BoundsOf<Vec3> put(const SpatialPlacement& s);
  static void load(const Real* hulls, const Real* base, const std::int32_t* o, ConvexShape& s);
  static Extent extent(const ConvexShape& s, Vec3 n, Mask lanes);
  static Vec3 support(const ConvexShape& s, Vec3 n, Mask lanes);
  static void feature(const ConvexShape& s, Vec3 n, Real tie, Feature& f);
};

// `hulls`: where the tables are; nullptr: behind the row, as that of a fixed shape.
MW_INLINE void load_pose(const Real* base, const std::int32_t* o, const Real* hulls, HullPose& h) {
  BoxPose box;
  load_pose(base, o, box);
  // Rows of other kinds of shapes may have no size.
  const Float least(Real(1e-12));
  h.r = box.r, h.p = box.p, h.margin = box.margin;
  h.half = {max(box.half.x, least), max(box.half.y, least), max(box.half.z, least)};
  load_tables(base, o, hulls, h.tables);
}
MW_INLINE BoundsOf<Vec3> HullPose::put(const SpatialPlacement& s) {
  put_box_row(s);
  store_rows4(s.rows + kernels::row_size<kernels::BoxRow>, s.offset,
              static_cast<Real>(s.collider.hull), Real(0), Real(0), Real(0));
  return box_bounds(s);
}
MW_INLINE Vec3 inverse_of(Vec3 half) {
  const Float one(Real(1));
  return {one / half.x, one / half.y, one / half.z};
}

// A face of each lane's hull: unit normal in world axes, how far the hull reaches along it from p.
struct HullFace {
  Vec3 normal;
  Float reach;
};
MW_INLINE HullFace placed_face(const HullQuad& m, const Mat3& r, Vec3 inverse_half) {
  const Vec3 local{m.x * inverse_half.x, m.y * inverse_half.y, m.z * inverse_half.z};
  // Rows of other kinds of shapes may have none.
  const Float inv = Float(Real(1)) / sqrt(max(dot(local, local), Real(1e-30)));
  return {mul(r, local * inv), m.w * inv};
}

MW_INLINE RayHit<Vec3> cast(const RayOf<Vec3>& ray, const HullPose& h) {
  const Vec3 from = ray.from - h.p, inverse = inverse_of(h.half);
  Clip clip;
  Vec3 normal = -ray.way;
  for (int i = 0; i < h.tables.most_faces; ++i) {
    const HullFace face = placed_face(face_of(h.tables, i), h.r, inverse);
    const Mask last = clip.add(dot(face.normal, from) - face.reach, -dot(face.normal, ray.way));
    normal = select(last, face.normal, normal);
  }
  return clipped(ray, clip, normal);
}

// ---- as a convex shape -------------------------------------------------------------------------

MW_INLINE Vec3 placed_corner(const ConvexShape& s, const HullQuad& u) {
  return mul(s.r, {u.x * s.half.x, u.y * s.half.y, u.z * s.half.z});
}

inline void HullPose::load(const Real* hulls, const Real* base, const std::int32_t* o,
                           ConvexShape& s) {
  HullPose pose;
  load_pose(base, o, hulls, pose);
  s.p = pose.p, s.r = pose.r, s.half = pose.half, s.margin = pose.margin, s.hull = pose.tables;
}

// A direction in the shape's axes, such that its product with a corner is how far that reaches.
MW_INLINE Vec3 in_corners(const ConvexShape& s, Vec3 n) {
  return times(mul_transposed(s.r, n), s.half);
}
inline Extent HullPose::extent(const ConvexShape& s, Vec3 n, Mask lanes) {
  const Vec3 l = in_corners(s, n);
  const auto reach = [&](Vec3 way) {
    const Float index = farthest_corner(s.hull, way, lanes);
    return along(chosen_quad(s.hull, s.hull.first_corner, index, 1), way);
  };
  return {-reach(-l), reach(l)};
}
inline Vec3 HullPose::support(const ConvexShape& s, Vec3 n, Mask lanes) {
  const Float index = farthest_corner(s.hull, in_corners(s, n), lanes);
  return placed_corner(s, chosen_quad(s.hull, s.hull.first_corner, index, 1));
}

// visit(face, its number) in order: all, or those that a map lists for a direction.
template <class Visit>
MW_INLINE void for_each_face_near(const HullTables& t, Vec3 l, Visit visit) {
  if (t.faces_mapped) return for_each_listed(t, t.face_map, t.first_face, 2, l, visit);
  for (int i = 0; i < t.most_faces; ++i) visit(face_of(t, i), Float(static_cast<Real>(i)));
}
// The first face that looks along n as much as any, or less by up to `tie`. Cosines are compared as
// x |x| / length^2.
inline Float best_face(const ConvexShape& s, Vec3 n, Real tie) {
  const Vec3 l = mul_transposed(s.r, n), inverse = inverse_of(s.half);
  Float square, length2;
  const auto look = [&](const HullQuad& m) {
    const Vec3 local{m.x * inverse.x, m.y * inverse.y, m.z * inverse.z};
    const Float x = dot(local, l);
    square = x * abs(x), length2 = dot(local, local);
  };
  Float most(Real(-4)), most_length2(Real(1)), index(Real(0));
  for_each_face_near(s.hull, l, [&](const HullQuad& m, Float i) {
    look(m);
    const Mask better = most * length2 < square * most_length2;
    most = select(better, square, most);
    most_length2 = select(better, length2, most_length2);
    index = select(better, i, index);
  });
  if (tie == Real(0)) return index;
  most = most / most_length2;
  const Float least = copysign(sqrt(abs(most)), most) - Float(tie);
  const Float least_square = least * abs(least);
  for_each_face_near(s.hull, l, [&](const HullQuad& m, Float i) {
    look(m);
    index = select((least_square * length2 <= square) & (i < index), i, index);
  });
  return index;
}
MW_INLINE HullFace face_at(const ConvexShape& s, Float index) {
  return placed_face(chosen_quad(s.hull, s.hull.first_face, index, 2), s.r, inverse_of(s.half));
}

inline void HullPose::feature(const ConvexShape& s, Vec3 n, Real tie, Feature& f) {
  const HullTables& t = s.hull;
  const Float one(Real(1)), index = best_face(s, n, tie);
  f.normal = face_at(s, index).normal;
  f.face = mask_from_bits(kAllLanes);
  alignas(64) std::int32_t first[kLanes], count[kLanes], o[kLanes];
  alignas(64) Real chosen[kLanes], code[kLanes];
  index.store(chosen);
  f.count = 0;
  for (int l = 0; l < kLanes; ++l) {
    const int face = static_cast<int>(chosen[l]);
    const Real* row = t.rows + t.first_face[l] + 8 * face;
    code[l] = static_cast<Real>(face % kernels::kFaceCodes);
    const bool there = t.faces[l] > 0;
    count[l] = there ? static_cast<int>(row[5]) : 0;
    first[l] = t.first_face[l] + 8 * t.faces[l] + (there ? 4 * static_cast<int>(row[4]) : 0);
    f.count = count[l] > f.count ? count[l] : f.count;
  }
  f.code = Float::load(code);
  for (int i = 0; i < f.count; ++i) {
    row_offsets(first, count, i, 1, o);
    f.corner[i] = placed_corner(s, load_quad(t, o));
  }
  const Vec3 edge = f.corner[1] - f.corner[0];
  const Float l2 = dot(edge, edge);
  const Mask real = Float(Real(0)) < l2;
  f.along = select(real, edge * (one / sqrt(select(real, l2, one))), s.r.x);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
