// The normal along which two convex shapes are farthest apart, or overlap least.
//
// Candidates come first: the faces' normals of both and a few that round shapes have. From the best
// of them a search goes up hill (convex_search.hpp). Hulls have too many faces for that
// (hull_axes.cpp).
#include "kernels/collide/convex_search.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

// Of a hull that has more faces so many are tried, spread over it.
constexpr int kTries = 32;

HullQuad one_of_some_faces(const HullTables& t, int k) {
  alignas(64) std::int32_t o[kLanes];
  for (int l = 0; l < kLanes; ++l) {
    const int count = t.faces[l], last = count > 0 ? count - 1 : 0;
    o[l] = t.first_face[l] + 8 * (count > kTries ? k * count / kTries : k < last ? k : last);
  }
  return load_quad(t, o);
}
void try_faces_of_hull(const ConvexShape& s, const ConvexShape& other, Vec3 d, Mask lanes,
                       Best& best) {
  const Vec3 inverse = inverse_of(s.half);
  for (int k = 0; k < s.hull.most_faces && k < kTries; ++k) {
    const HullFace face = placed_face(one_of_some_faces(s.hull, k), s.r, inverse);
    best.take(face.normal, dot(face.normal, d + support(other, -face.normal, lanes)) - face.reach);
  }
}

}  // namespace

void try_faces(const ConvexShape& s, const ConvexShape& other, Vec3 d, Mask lanes, Best& best) {
  if (s.kind == ShapeKind::hull) return try_faces_of_hull(s, other, d, lanes, best);
  if (s.kind == ShapeKind::tile) {
    const Vec3 n = s.face_normal;
    best.take(n, dot(n, d - s.vertex[0]) + extent_along(other, n, lanes).low);
    return;
  }
  const auto both_sides = [&](Vec3 axis, Float half) {
    const Extent e = extent_along(other, axis, lanes);
    const Float along = dot(axis, d);
    best.take(axis, along + e.low - half);
    best.take(-axis, -(along + e.high) - half);
  };
  if (s.kind == ShapeKind::box) {
    both_sides(s.r.x, s.half.x);
    both_sides(s.r.y, s.half.y);
  }
  if (s.kind == ShapeKind::box || s.kind == ShapeKind::cylinder) both_sides(s.r.z, s.half.z);
}

// Normals that no face has, to start from: along the line of centres and across axes.
void try_others(const ConvexShape& a, const ConvexShape& b, Vec3 d, Mask lanes, Best& best) {
  const Float one(Real(1)), least(Real(1e-6));
  const auto look = [&](Vec3 n) {
    n = n * copysign(one, dot(n, d));
    best.take(n, dot(n, d) + extent_along(b, n, lanes).low - extent_along(a, n, lanes).high);
  };
  look(normalized(d, Real(1e-20), {Real(0), Real(0), one}));
  const auto across_axis = [&](Vec3 axis) {
    const Vec3 out = fnma(axis, dot(axis, d), d);
    look(normalized(out, Real(1e-12), any_tangent(axis)));
  };
  const auto product = [&](Vec3 u, Vec3 v) {
    look(normalized(cross(u, v), least, any_tangent(u)));
  };
  if (has_axis(a.kind)) across_axis(a.r.z);
  if (has_axis(b.kind)) across_axis(b.r.z);
  if (has_axis(a.kind) && has_axis(b.kind)) product(a.r.z, b.r.z);
  const ConvexShape& box = a.kind == ShapeKind::box ? a : b;
  const ConvexShape& round = a.kind == ShapeKind::box ? b : a;
  if (box.kind != ShapeKind::box || !has_axis(round.kind)) return;
  product(box.r.x, round.r.z);
  product(box.r.y, round.r.z);
  product(box.r.z, round.r.z);
}

void find_convex_axis(const Constants& t, const ConvexShape& a, const ConvexShape& b, Mask active,
                      ConvexAxis& out) {
  if (a.kind == ShapeKind::hull || b.kind == ShapeKind::hull) {
    return find_axis_of_hull(t, a, b, active, out);
  }
  const Float zero(Real(0)), never(Real(-1e30));
  const Vec3 d = b.p - a.p;
  const Vec3 up{zero, zero, Float(Real(1))};
  Best of_a{up, never}, of_b{up, never};
  try_faces(a, b, d, active, of_a);
  try_faces(b, a, -d, active, of_b);
  out.face_of_b = of_a.separation + Float(t.face_tie) < of_b.separation;
  out.face_of_b = out.face_of_b | (max(of_a.separation, zero) < of_b.separation);
  out.face_separation = select(out.face_of_b, of_b.separation, of_a.separation);
  out.face_normal = select(out.face_of_b, -of_b.normal, of_a.normal);
  Best best{out.face_normal, out.face_separation};
  best.take(of_a.normal, of_a.separation);
  try_others(a, b, d, active, best);
  out.near = active & (best.separation < a.margin + b.margin);

  const Float size = size_of_pair(a, b, d), tolerance = size * Float(kTolerance);
  Simplex s{};
  if (any(out.near)) climb(a, b, d, tolerance, kNoLimit, false, out.near, best, s);
  // Deep in one another there are several hills.
  const Mask deep = out.near & (best.separation < size * Float(-kDeep));
  if (any(deep)) {
    climb_again(a, b, d, tolerance, kNoLimit, of_a.normal, -of_b.normal, deep, best, s);
  }
  out.normal = best.normal;
  out.separation = best.separation;
  out.on_a = s.on_a;
  out.on_b = s.on_b;
  out.touch = mask_from_bits(kAllLanes);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
