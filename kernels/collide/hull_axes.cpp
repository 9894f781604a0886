// The normal along which a hull and another shape are farthest apart, or overlap least.
//
// A hull has too many faces to try each. The search begins where the boxes around the two shapes
// overlap least, or where the line of centres is better, and ends as soon as it leaves the margins.
// Deep in one another it begins once more from what is best of some faces. In the end those faces
// count that look along what it has found.
#include "kernels/collide/box_around.hpp"
#include "kernels/collide/convex_search.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

// The face of a shape that looks along n most.
HullFace face_along_axes(const ConvexShape& s, Vec3 n) {
  HullFace out{s.r.z, s.half.z};
  Float best(Real(-1));
  const auto take = [&](Vec3 axis, Float half) {
    const Float cosine = dot(axis, n);
    const Mask better = best < abs(cosine);
    best = max(abs(cosine), best);
    out.normal = select(better, axis * copysign(Float(Real(1)), cosine), out.normal);
    out.reach = select(better, half, out.reach);
  };
  if (s.kind == ShapeKind::box) take(s.r.x, s.half.x), take(s.r.y, s.half.y);
  take(s.r.z, s.half.z);
  return out;
}
HullFace face_that_looks(const ConvexShape& s, Vec3 n) {
  if (s.kind == ShapeKind::tile) return {s.face_normal, dot(s.face_normal, s.vertex[0])};
  if (s.kind == ShapeKind::hull) return face_at(s, best_face(s, n, Real(0)));
  return face_along_axes(s, n);
}
bool has_faces(ShapeKind kind) {
  return kind == ShapeKind::hull || kind == ShapeKind::box || kind == ShapeKind::cylinder ||
         kind == ShapeKind::tile;
}

// The faces that look along the best normal, in some lanes.
void find_faces(const Constants& t, const ConvexShape& a, const ConvexShape& b, Vec3 d, Mask lanes,
                Best& best, ConvexAxis& out) {
  const Float zero(Real(0)), never(Real(-1e30));
  out.face_of_b = mask_from_bits(0);
  out.face_separation = never, out.face_normal = best.normal;
  if (!any(lanes)) return;
  HullFace of_a{best.normal, zero}, of_b{-best.normal, zero};
  Float along_a = never, along_b = never;
  if (has_faces(a.kind)) {
    of_a = face_that_looks(a, best.normal);
    along_a = dot(of_a.normal, d + support(b, -of_a.normal, lanes)) - of_a.reach;
  }
  if (has_faces(b.kind)) {
    of_b = face_that_looks(b, -best.normal);
    along_b = dot(of_b.normal, support(a, -of_b.normal, lanes) - d) - of_b.reach;
  }
  const Mask by_b = (along_a + Float(t.face_tie) < along_b) | (max(along_a, zero) < along_b);
  out.face_of_b = lanes & by_b;
  out.face_separation = select(lanes, select(by_b, along_b, along_a), never);
  out.face_normal = select(lanes, select(by_b, -of_b.normal, of_a.normal), best.normal);
  Best with = best;
  with.take(out.face_normal, out.face_separation);
  best = select(lanes, with, best);
}

}  // namespace

void find_axis_of_hull(const Constants& t, const ConvexShape& a, const ConvexShape& b, Mask active,
                       ConvexAxis& out) {
  const Float zero(Real(0));
  const Vec3 d = b.p - a.p;
  const Float limit = a.margin + b.margin;
  const Float size = size_of_pair(a, b, d), tolerance = size * Float(kTolerance);
  const auto separation_along = [&](Vec3 n) { return dot(n, corner_along(a, b, d, n, active).w); };

  AxisOfBoxes boxes = find_axis_of_boxes(box_around(a), box_around(b));
  // The box around a tile is no tight one.
  if (a.kind == ShapeKind::tile) boxes.normal = a.face_normal;
  Best best{boxes.normal, separation_along(boxes.normal)};
  // What is found in a lane hangs on that lane alone.
  const auto near = [&] { return active & (best.separation < limit); };
  out.near = near();
  Simplex s{};
  if (any(out.near)) {
    Best other = best;
    try_others(a, b, d, out.near, other);
    best = select(out.near, other, best);
    out.near = near();
    climb(a, b, d, tolerance, limit, false, out.near, best, s);
    out.near = near();
  }
  const Mask deep = out.near & (best.separation < size * Float(-kDeep));
  if (any(deep)) {
    Best of_a{boxes.normal, Real(-1e30)}, of_b{-boxes.normal, Real(-1e30)};
    try_faces(a, b, d, deep, of_a), try_faces(b, a, -d, deep, of_b);
    climb_again(a, b, d, tolerance, limit, of_a.normal, -of_b.normal, deep, best, s);
  }
  out.on_a = s.on_a, out.on_b = s.on_b;
  out.touch = mask_from_bits(kAllLanes);
  // What is below a tile touches it however far it is (collide_convex.cpp).
  find_faces(t, a, b, d, a.kind == ShapeKind::tile ? active : out.near, best, out);
  out.normal = best.normal, out.separation = best.separation;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
