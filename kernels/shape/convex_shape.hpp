// A convex shape in space of any kind, as the general method for pairs wants it: how far it reaches
// along a direction, which point does, and its faces (collide/convex.hpp). Each shape's file says
// how it is loaded and answers these.
//
// The kind is the same in all lanes, so asking for it is no branch of a lane's.
#pragma once

#include "kernels/data/shape_kinds.hpp"
#include "kernels/shape/tangent.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Where every lane finds its hull (data/pose_rows.hpp).
struct HullTables {
  const Real* rows;
  alignas(64) std::int32_t first_corner[kLanes], corners[kLanes], corner_map[kLanes];
  alignas(64) std::int32_t block[kLanes];  // of corners
  alignas(64) std::int32_t first_face[kLanes], faces[kLanes], face_map[kLanes];
  int most_corners, most_faces;       // of any lane
  bool shared;                        // all lanes have the same hull
  bool corners_mapped, faces_mapped;  // all lanes have maps
};

struct ConvexShape {
  kernels::ShapeKind kind;
  Vec3 p, half;  // half extents; capsule: half length in z
  Mat3 r;
  Float radius;  // around the core: of spheres and capsules
  Float margin;  // how far its bounds reach beyond it, m; spheres and capsules do not tell
  HullTables hull;
  Vec3 face_normal;                    // of a tile
  int vertices;                        // of a tile or a flat shape
  Vec3 vertex[kernels::kMaxVertices];  // from p, world axes
};

struct Extent {
  Float low, high;
};

// What lies farthest out along a direction: a face, or an edge or a point of a shape that is round
// there. A lane with fewer points repeats its last.
inline constexpr int kMaxCorners = kernels::kMaxOutline;
struct Feature {
  int count;
  Vec3 corner[kMaxCorners];  // from p, world axes; counter-clockwise seen from outside
  Vec3 normal;               // unit, outward; of a face
  Vec3 along;                // unit, fixed to the body: where the feature's own x axis is
  Float code;
  Mask face;
};

// Of tiles and flat shapes.
MW_INLINE Extent extent_of_vertices(const ConvexShape& s, Vec3 n) {
  const Float zero(Real(0));
  Float low = dot(s.vertex[0], n), high = low;
  for (int i = 1; i < s.vertices; ++i) {
    const Float x = dot(s.vertex[i], n);
    low = min(x, low), high = max(x, high);
  }
  return s.vertices > 0 ? Extent{low, high} : Extent{zero, zero};
}
MW_INLINE Vec3 support_of_vertices(const ConvexShape& s, Vec3 n) {
  Vec3 best = s.vertex[0];
  Float most = dot(best, n);
  for (int i = 1; i < s.vertices; ++i) {
    const Float x = dot(s.vertex[i], n);
    const Mask farther = most < x;
    most = max(x, most);
    best = select(farther, s.vertex[i], best);
  }
  return best;
}

// A point, or a line along an axis, with a radius around it.
MW_INLINE void set_round(ConvexShape& s, Vec3 p, Vec3 axis, Float radius, Float half) {
  const Float zero(Real(0));
  s.p = p;
  s.half = {zero, zero, half};
  s.radius = radius;
  s.r.x = any_tangent(axis);
  s.r.y = cross(axis, s.r.x), s.r.z = axis;
}
// The line along z of what is round about it, or a point.
MW_INLINE void line_feature(const ConvexShape& s, Vec3 n, Feature& f) {
  const Vec3 end = s.r.z * s.half.z;
  f.count = 2;
  f.corner[0] = -end, f.corner[1] = end;
  f.normal = n;
  f.along = s.r.z;
  f.code = Real(0);
  f.face = mask_from_bits(0);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
