// Convex shapes: loading, reach, features (collide/convex.hpp).
#include "kernels/collide/convex.hpp"
#include "kernels/collide/plane_box.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

MW_INLINE bool has_vertices(ShapeKind kind) {
  return kind == ShapeKind::hull || kind == ShapeKind::tile;
}

// How far and where to n points out of the axis of a cylinder. In the cap's own axes, so that it
// lies in the cap however little that is.
struct Outward {
  Float length;
  Vec3 way;  // unit; any where there is no length
};
MW_INLINE Outward out_of_axis(const ConvexShape& s, Vec3 n) {
  const Float one(Real(1)), x = dot(s.r.x, n), y = dot(s.r.y, n);
  const Float l2 = fma(x, x, y * y);
  const Mask real = Float(sizeof(Real) == 4 ? Real(1e-24) : Real(1e-40)) < l2;
  const Float length = sqrt(l2), inv = one / select(real, length, one);
  return {length, select(real, fma(s.r.x, x * inv, s.r.y * (y * inv)), s.r.x)};
}

MW_INLINE Vec3 load_corner(const ConvexShape& s, const std::int32_t* o) {
  Vec3 u;
  Float unused;
  load_rows4(s.hull.corners, o, u.x, u.y, u.z, unused);
  return mul(s.r, {u.x * s.half.x, u.y * s.half.y, u.z * s.half.z});
}

int most(const std::int32_t* count) {
  int out = 0;
  for (int l = 0; l < kLanes; ++l) out = count[l] > out ? count[l] : out;
  return out;
}

void load_vertices(const Real* base, const std::int32_t* offset, ConvexShape& s) {
  alignas(64) std::int32_t first[kLanes], count[kLanes], o[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    count[l] = static_cast<std::int32_t>(base[offset[l] + 17]);
    first[l] = s.hull.at[l] - 4 * count[l];
  }
  s.vertices = most(count);
  for (int i = 0; i < s.vertices; ++i) {
    corner_offsets(first, count, i, 1, o);
    s.vertex[i] = load_corner(s, o);
  }
}

void box_feature(const ConvexShape& s, Vec3 n, Feature& f) {
  const BoxPose box{s.r, s.p, s.half, Real(0)};
  const BoxFace face = opposed_face(box, -n);
  const Vec3 u = face.edge1 * face.sign, v = face.edge2;  // counter-clockwise on either side
  f.count = 4;
  f.corner[0] = face.centre - u - v, f.corner[1] = face.centre + u - v;
  f.corner[2] = face.centre + u + v, f.corner[3] = face.centre - u + v;
  f.normal = pick(face.axis, s.r) * face.sign;
  f.along = face.edge1 * (Float(Real(1)) / max(face.half1, Real(1e-20)));
  f.code = face.code;
  f.face = mask_from_bits(kAllLanes);
}

// The side of a cylinder is a line, a cap four points of its rim, always the same ones.
void cylinder_feature(const ConvexShape& s, Vec3 n, Feature& f) {
  const Float zero(Real(0)), one(Real(1)), along = dot(s.r.z, n);
  const Vec3 lowest = out_of_axis(s, n).way;
  const Mask cap = Float(Real(0.7)) < abs(along);
  const Float sign = copysign(one, along);
  const Vec3 end = s.r.z * s.half.z, top = end * sign, side = lowest * s.half.x;
  const Vec3 x = s.r.x * s.half.x, y = s.r.y * (s.half.x * sign);
  f.count = all(!cap) ? 2 : 4;
  f.corner[0] = select(cap, top + x, side - end);
  f.corner[1] = select(cap, top + y, side + end);
  f.corner[2] = select(cap, top - x, side + end);
  f.corner[3] = select(cap, top - y, side + end);
  f.normal = select(cap, s.r.z * sign, lowest);
  f.along = select(cap, s.r.x, s.r.z);
  f.code = select(cap, select(zero < along, one, Float(Real(2))), zero);
  f.face = cap;
}

void hull_feature(const ConvexShape& s, Vec3 n, Real tie, Feature& f) {
  const HullPose& hull = s.hull;
  const Float one(Real(1));
  const Vec3 inverse = inverse_of(s.half);
  Float best = Real(-2), index = Real(0);
  f.normal = n;
  for (int i = 0; i < hull.most_faces; ++i) {
    const Vec3 normal = hull_face(hull, inverse, i).normal;
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
    const Real* row = hull.corners + hull.at[l] + 8 * static_cast<int>(chosen[l]);
    count[l] = hull.faces[l] > 0 ? static_cast<int>(row[5]) : 0;
    first[l] =
        hull.at[l] + 8 * hull.faces[l] + (hull.faces[l] > 0 ? 4 * static_cast<int>(row[4]) : 0);
  }
  f.count = most(count);
  for (int i = 0; i < f.count; ++i) {
    corner_offsets(first, count, i, 1, o);
    f.corner[i] = load_corner(s, o);
  }
  const Vec3 edge = f.corner[1] - f.corner[0];
  const Float l2 = dot(edge, edge);
  const Mask real = Float(Real(0)) < l2;
  f.along = select(real, edge * (one / sqrt(select(real, l2, one))), s.r.x);
}

void tile_feature(const ConvexShape& s, Feature& f) {
  f.count = 3;
  for (int i = 0; i < 3; ++i) f.corner[i] = s.vertex[i];
  f.normal = s.face_normal;
  const Vec3 edge = s.vertex[1] - s.vertex[0];
  f.along = edge * (Float(Real(1)) / sqrt(max(dot(edge, edge), Real(1e-30))));
  f.code = Real(0);
  f.face = mask_from_bits(kAllLanes);
}

}  // namespace

void load_convex(const Real* hulls, ShapeKind kind, const Real* base, const std::int32_t* offset,
                 ConvexShape& s) {
  const Float zero(Real(0));
  s.kind = kind;
  s.radius = zero;
  s.vertices = 0;
  s.margin = Real(1e18);
  if (kind == ShapeKind::sphere || kind == ShapeKind::capsule) {
    CapsulePose<Vec3> pose{};
    if (kind == ShapeKind::sphere) {
      SpherePose ball;
      load_pose(base, offset, ball);
      pose = {ball.p, {zero, zero, Real(1)}, ball.radius, zero};
    } else {
      load_pose(base, offset, pose);
    }
    s.p = pose.p;
    s.half = {zero, zero, pose.half};
    s.radius = pose.radius;
    s.r.x = any_tangent(pose.axis);
    s.r.y = cross(pose.axis, s.r.x), s.r.z = pose.axis;
    return;
  }
  if (kind == ShapeKind::hull) {
    load_hull(base, offset, hulls, s.hull);
    s.p = s.hull.p, s.r = s.hull.r, s.half = s.hull.half, s.margin = s.hull.margin;
    return load_vertices(base, offset, s);
  }
  BoxPose box;
  load_pose(base, offset, box);
  s.p = box.p, s.r = box.r, s.half = box.half, s.margin = box.margin;
}

Extent extent_along(const ConvexShape& s, Vec3 n) {
  const Float zero(Real(0));
  if (has_vertices(s.kind)) {
    Float low = dot(s.vertex[0], n), high = low;
    for (int i = 1; i < s.vertices; ++i) {
      const Float x = dot(s.vertex[i], n);
      low = min(x, low), high = max(x, high);
    }
    return s.vertices > 0 ? Extent{low, high} : Extent{zero, zero};
  }
  const Float along = dot(s.r.z, n);
  Float reach = abs(along) * s.half.z;
  if (s.kind == ShapeKind::box) {
    reach = fma(abs(dot(s.r.x, n)), s.half.x, fma(abs(dot(s.r.y, n)), s.half.y, reach));
  } else if (s.kind == ShapeKind::cylinder) {
    reach = fma(out_of_axis(s, n).length, s.half.x, reach);
  }
  return {-reach, reach};
}

Vec3 support(const ConvexShape& s, Vec3 n) {
  const Float zero(Real(0)), one(Real(1));
  if (s.kind == ShapeKind::sphere) return {zero, zero, zero};
  if (has_vertices(s.kind)) {
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
  Vec3 out = s.r.z * copysign(s.half.z, dot(s.r.z, n));
  if (s.kind == ShapeKind::box) {
    out = fma(s.r.x, copysign(s.half.x, dot(s.r.x, n)), out);
    out = fma(s.r.y, copysign(s.half.y, dot(s.r.y, n)), out);
  } else if (s.kind == ShapeKind::cylinder) {
    out = fma(out_of_axis(s, n).way, s.half.x, out);
  }
  return out;
}

void feature_along(const ConvexShape& s, Vec3 n, Real tie, Feature& f) {
  if (s.kind == ShapeKind::box) return box_feature(s, n, f);
  if (s.kind == ShapeKind::cylinder) return cylinder_feature(s, n, f);
  if (s.kind == ShapeKind::hull) return hull_feature(s, n, tie, f);
  if (s.kind == ShapeKind::tile) return tile_feature(s, f);
  const Vec3 end = s.r.z * s.half.z;
  f.count = 2;
  f.corner[0] = -end, f.corner[1] = end;
  f.normal = n;
  f.along = s.r.z;
  f.code = Real(0);
  f.face = mask_from_bits(0);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
