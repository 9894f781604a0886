// Manifolds of two convex shapes, and of one on a plane.
//
// Where a face's normal is (nearly) the best, the other shape's feature that looks at that face
// most is clipped against it (clip_face.hpp). Two lines side by side (the sides of cylinders,
// capsules) touch at the ends of the stretch that they share; all else at one point, the one that
// the search for the normal found.
#include "kernels/collide/capsule_capsule.hpp"
#include "kernels/collide/clip_face.hpp"
#include "kernels/collide/tile.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

MW_INLINE bool is_line(ShapeKind kind) {
  return kind == ShapeKind::cylinder || kind == ShapeKind::capsule;
}

// Sides of two shapes that have an axis, side by side: two points, in some lanes of `use`.
void put_lines(const ConvexShape& a, const ConvexShape& b, const ConvexAxis& axis, Vec3 d, Mask use,
               Manifold<Isotropic, 4>& m) {
  const Float zero(Real(0));
  const Float cosine = dot(a.r.z, b.r.z), da = dot(a.r.z, d), db = dot(b.r.z, d);
  const Vec3 product = cross(a.r.z, b.r.z);
  const Float low = max(-a.half.z, da - b.half.z), high = min(a.half.z, da + b.half.z);
  const Float flat(Real(0.02));
  const Mask beside = use & (dot(product, product) < Float(kParallel2)) & (low < high) &
                      (abs(dot(axis.normal, a.r.z)) < flat) & (abs(dot(axis.normal, b.r.z)) < flat);
  const Float radius_a = a.half.x + a.radius, radius_b = b.half.x + b.radius;
  for (int i = 0; i < 2; ++i) {
    const Float place = i == 0 ? low : high;
    const Vec3 base = a.r.z * place;
    const Float opposite = clamp(fms(cosine, place, db), -b.half.z, b.half.z);
    const Float gap = dot(axis.normal, fma(b.r.z, opposite, d) - base) - radius_a - radius_b;
    const Float half(Real(0.5));
    const Vec3 on_a = fma(axis.normal, fma(min(gap, zero), half, radius_a), base);
    const Vec3 on_b = fma(axis.normal, radius_a + max(gap, gap * half), base) - d;
    m.separation[i] = select(beside, gap, m.separation[i]);
    m.point_a[i] = select(beside, on_a, m.point_a[i]);
    m.point_b[i] = select(beside, on_b, m.point_b[i]);
    m.feature_x[i] = select(beside, place, m.feature_x[i]);
    m.valid[i] = m.valid[i] | beside;
  }
  m.code = select(beside, Float(Real(60001)), m.code);
  m.match_distance2 = select(beside, match_distance2(min(a.half.z, b.half.z)), m.match_distance2);
}

// Guards where sides are less parallel than that.
void guard_sides(const ConvexShape& a, const ConvexShape& b, const ConvexAxis& axis, Vec3 d,
                 Mask use, Manifold<Isotropic, 4>& m) {
  const auto side_of = [&](const ConvexShape& s, Real way, Float along) {
    const Float radius = s.half.x + s.radius;
    const Vec3 out = fnma(s.r.z, along, axis.normal);
    const Float size = sqrt(max(dot(out, out), Float(Real(1) - kSideOn * kSideOn)));
    return SideLine{s.r.z, s.half.z, radius, out * (radius * Float(way) / size)};
  };
  const Float along_a = dot(axis.normal, a.r.z), along_b = dot(axis.normal, b.r.z);
  const Mask sides = use & (max(abs(along_a), abs(along_b)) < Float(kSideOn));
  const Float nearest = dot(a.r.z, axis.on_a);
  put_side_guards(side_of(a, 1, along_a), side_of(b, -1, along_b), d, nearest, sides, m);
}

// One point, where the search ended; everywhere to begin with.
void put_found(const ConvexShape& a, const ConvexShape& b, const ConvexAxis& axis, Vec3 d,
               Manifold<Isotropic, 4>& m) {
  const Float zero(Real(0)), half(Real(0.5));
  m.normal = axis.normal;
  m.tangent = tangent_along(a.r.z, axis.normal);
  const Float gap = axis.separation - b.radius;
  m.separation[0] = gap;
  // Half way between the two, or on each one's surface when they are apart.
  const Vec3 surface_b = fnma(axis.normal, b.radius, axis.on_b);
  const Vec3 middle = (axis.on_a + surface_b) * half;
  const Mask apart = zero < gap;
  m.point_a[0] = select(apart, axis.on_a, middle);
  m.point_b[0] = select(apart, surface_b, middle) - d;
  m.feature_x[0] = m.feature_y[0] = zero;
  m.valid[0] = mask_from_bits(kAllLanes);
  leave_out_points(m, 1);
  m.code = Real(60000);
  // It may wander.
  m.match_distance2 = square(a.half.x + a.half.y + a.half.z);
}

// Guards where no face's normal is the best, and no sides lie beside each other.
void guard_edges(const Constants& t, const ConvexShape& a, const ConvexShape& b,
                 const ConvexAxis& axis, Vec3 d, Mask use, Manifold<Isotropic, 4>& m) {
  use = use & !(m.valid[1] | m.valid[2]);
  if (!any(use)) return;
  Feature of_a, of_b;
  feature_along(a, axis.normal, Real(0), of_a);
  feature_along(b, -axis.normal, Real(0), of_b);
  const Float none(Real(-2));
  const Mask on_a = use & (select(of_b.face, -dot(of_b.normal, axis.normal), none) <=
                           select(of_a.face, dot(of_a.normal, axis.normal), none));
  const Mask on_b = use & !on_a;
  if (any(on_a)) clip_guards(t, a, b, axis, d, false, on_a, m);
  if (any(on_b)) clip_guards(t, b, a, axis, d, true, on_b, m);
}

// Leaves an axis only normals that the tile's surface has; its own where there is another. The
// point that is deepest along that may be beside the triangle, and nothing touches there.
void keep_to_surface(const Tile& tile, const ConvexShape& b, Vec3 d, ConvexAxis& axis) {
  const Vec3 n = tile.normal;
  const Vec3 lowest = support(b, -n, mask_from_bits(kAllLanes)) + d;
  const Float separation = dot(n, lowest - tile.vertex[0]);
  // A shape below the triangle is not apart from it but inside the solid.
  const Mask below = is_below(tile, d), other = below | !has_normal(tile, axis.normal);
  axis.near = axis.near | (below & tile.there);
  axis.normal = select(other, n, axis.normal);
  axis.separation = select(other, separation, axis.separation);
  axis.on_b = select(other, lowest, axis.on_b);
  axis.on_a = select(other, fnma(n, separation, lowest), axis.on_a);
  const Mask other_face = axis.face_of_b & (below | !has_normal(tile, axis.face_normal));
  axis.face_normal = select(other_face, n, axis.face_normal);
  axis.face_separation = select(other_face, separation, axis.face_separation);
  axis.face_of_b = axis.face_of_b & !other_face;
  axis.touch = (!other) | is_over(tile, lowest, Real(0)) | below;
}

}  // namespace

void collide_convex_pair(const Constants& t, const ConvexShape& a, const Tile* tile,
                         const ConvexShape& b, Mask active, Manifold<Isotropic, 4>& m) {
  const Float zero(Real(0));
  const Vec3 d = b.p - a.p;
  ConvexAxis axis;
  if (tile) active = active & tile->there;
  find_convex_axis(t, a, b, active, axis);
  if (tile) keep_to_surface(*tile, b, d, axis);
  put_found(a, b, axis, d, m);
  active = axis.near;
  m.valid[0] = active & axis.touch;
  if (!any(active)) return;
  if (is_line(a.kind) && is_line(b.kind)) {
    put_lines(a, b, axis, d, active, m);
    if (t.tree.links == 0) guard_sides(a, b, axis, d, active & axis.touch & !m.valid[1], m);
  }
  // Faces win near ties. What is round around its core shows where the core is apart: there only
  // rounding is a tie.
  const Float face = axis.face_separation, other = axis.separation;
  const bool round = b.kind == ShapeKind::capsule;
  const Real rounding = sizeof(Real) == 4 ? Real(4e-6) : Real(1e-13);
  const Float size = sqrt(dot(d, d));
  const Float best_apart = max(face, zero), tie = round ? size * Float(rounding) : zero;
  const Mask apart = tie < other;  // what just touches, with faces far inside, is apart from none
  const Mask worse_apart = best_apart + tie < other;
  Mask worse = fma(face, Real(0.95), t.face_bias) < other;
  worse = round ? (worse & !apart) | (apart & worse_apart) : worse & (worse_apart | !apart);
  if (!tile && t.tree.links == 0) guard_edges(t, a, b, axis, d, active & worse & axis.touch, m);
  const Mask clipped = active & !worse;
  if (!any(clipped)) return;
  const Mask on_b = clipped & axis.face_of_b, on_a = clipped & !axis.face_of_b;
  if (any(on_a)) clip_on_face(t, a, b, axis, d, false, on_a, m);
  if (any(on_b)) clip_on_face(t, b, a, axis, d, true, on_b, m);
}

void collide_plane_convex(const Constants& t, const PlanePose& a, const ConvexShape& b,
                          Manifold<Isotropic, 4>& m) {
  const Float zero(Real(0));
  Feature f;
  feature_along(b, -a.normal, Real(1e-3), f);
  const Frame frame = frame_of(a.normal, f.along, a.offset - dot(a.normal, b.p));
  Outline outline;
  bring(frame, b, f, {zero, zero, zero}, outline);
  Clipped points;
  for (int i = 0; i < f.count; ++i) {
    points.add(outline.corner[i].x, outline.corner[i].y, outline.corner[i].z);
  }
  add_deepest(outline, false, frame.local(support(b, -a.normal, mask_from_bits(kAllLanes))),
              mask_from_bits(kAllLanes), Float(t.face_bias) * Float(kClearly), points);
  KeptPoints kept;
  keep_four(points, Float(Real(1e4)), Float(t.margin * kLevel), outline.extent2, kept);
  m.normal = a.normal;
  m.tangent = a.tangent;
  for (int i = 0; i < 4; ++i) {
    const Float z = kept.z[i];
    m.separation[i] = min(z, Real(1e3));
    const Vec3 base = fma(frame.v, kept.y[i], frame.u * kept.x[i]);
    // On its own surface, or half way up to the plane.
    const Float up = m.separation[i] + frame.height;
    m.point_b[i] = fma(a.normal, fma(min(m.separation[i], zero), Real(-0.5), up), base);
    m.point_a[i] = m.point_b[i];
    m.feature_x[i] = kept.x[i];
    m.feature_y[i] = kept.y[i];
    m.valid[i] = kept.valid[i];
  }
  m.code = f.code;
  m.match_distance2 = match_distance2(sqrt(outline.extent2) * Float(Real(0.7)));
}

namespace {

// In the half plane through the axis and the centre a cylinder is a rectangle.
void cylinder_sphere(const ConvexShape& a, Vec3 d, Vec3& normal, Float& separation) {
  const Float zero(Real(0)), one(Real(1));
  const Float height = dot(a.r.z, d);
  const Vec3 out = fnma(a.r.z, height, d);
  const Float l2 = dot(out, out);
  const Mask off_axis = Float(kTinyDistance2) < l2;
  const Float reach = sqrt(select(off_axis, l2, zero));
  const Vec3 radial = select(off_axis, out * (one / sqrt(select(off_axis, l2, one))), a.r.x);
  const Float gr = reach - a.half.x, gz = abs(height) - a.half.z;
  const Float x = max(gr, zero), z = max(gz, zero);
  const Float d2 = fma(x, x, z * z);
  const Mask outside = Float(kTinyDistance2) < d2;
  const Float inv = one / sqrt(select(outside, d2, one));
  const Vec3 up = a.r.z * copysign(one, height);
  normal = select(outside, fma(radial, x * inv, up * (z * inv)), select(gr < gz, up, radial));
  separation = select(outside, sqrt(d2), max(gr, gz));
}

}  // namespace

void collide_plane_point(const PlanePose& a, const ConvexShape& b, Manifold<Isotropic, 1>& m) {
  const Float zero(Real(0));
  const Vec3 lowest = support(b, -a.normal, mask_from_bits(kAllLanes));
  m.normal = a.normal;
  m.tangent = a.tangent;
  m.separation[0] = dot(a.normal, b.p) - a.offset + dot(a.normal, lowest);
  m.point_b[0] = fma(a.normal, min(m.separation[0], zero) * Float(Real(-0.5)), lowest);
  m.point_a[0] = m.point_b[0];
  m.feature_x[0] = m.feature_y[0] = zero;
  m.code = zero;
  m.match_distance2 = zero;
  m.valid[0] = mask_from_bits(kAllLanes);
}

void collide_convex_point(const Constants& t, const ConvexShape& a, const Tile* tile,
                          const ConvexShape& b, Mask active, Manifold<Isotropic, 1>& m) {
  const Float zero(Real(0)), half(Real(0.5));
  const Vec3 d = b.p - a.p;
  const bool sphere = b.kind == ShapeKind::sphere;
  m.valid[0] = mask_from_bits(kAllLanes);
  ConvexAxis axis;
  if (a.kind == ShapeKind::cylinder && sphere) {
    cylinder_sphere(a, d, axis.normal, axis.separation);
  } else {
    if (tile) active = active & tile->there;
    find_convex_axis(t, a, b, active, axis);
  }
  if (tile) {
    keep_to_surface(*tile, b, d, axis);
    m.valid[0] = axis.near & axis.touch;
  } else if (!sphere) {
    m.valid[0] = axis.near;
  }
  const Vec3 normal = axis.normal;
  const Float separation = axis.separation - b.radius;
  m.normal = normal;
  m.tangent = any_tangent(normal);
  m.separation[0] = separation;
  if (sphere) {
    m.point_b[0] = normal * -fma(min(separation, zero), half, b.radius);
    m.point_a[0] = fma(normal, -max(separation, zero), m.point_b[0] + d);
  } else {
    // Half way between the two, or on each one's surface when they are apart.
    const Vec3 surface_b = fnma(normal, b.radius, axis.on_b),
               middle = (axis.on_a + surface_b) * half;
    const Mask apart = zero < separation;
    m.point_a[0] = select(apart, axis.on_a, middle);
    m.point_b[0] = select(apart, surface_b, middle) - d;
  }
  m.feature_x[0] = m.feature_y[0] = zero;
  m.code = zero;
  m.match_distance2 = zero;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
