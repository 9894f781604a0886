// Manifolds of two convex shapes, and of one on a plane.
//
// Where a face's normal is (nearly) the best, the other shape's feature that looks at that face
// most is clipped against it: each of its edges against all sides of the face, and the corners of
// the face that lie under it. Four points are kept as for boxes. Two lines side by side (the sides
// of cylinders, capsules) touch at the ends of the stretch that they share; all else at one point,
// the one that the search for the normal found.
#include "kernels/collide/capsule_capsule.hpp"
#include "kernels/collide/outline.hpp"
#include "kernels/collide/tile.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

// Of the line from p to q what lies over the face, as shares of it.
struct Stretch {
  Float enter, leave;
  Mask there;
};
MW_INLINE Stretch over_sides(const Outline& ref, Float slack, Vec3 p, Vec3 q) {
  const Float zero(Real(0)), one(Real(1));
  Float enter = zero, leave = one;
  Mask misses = zero < zero;
  for (int i = 0; i < ref.count; ++i) {
    const Side side = side_of(ref, i, slack);
    const Float from = side.outside(p.x, p.y), to = side.outside(q.x, q.y);
    const Float change = from - to;
    const Float at = from / safe_divisor(change, ref.extent2);
    enter = select((zero < change) & (zero < from), max(enter, min(at, one)), enter);
    leave = select((change <= zero) & (zero < to), min(leave, max(at, zero)), leave);
    misses = misses | ((zero < from) & (zero < to));
  }
  return {enter, leave, (enter <= leave) & !misses};
}
MW_INLINE Stretch over_disc(const Outline& ref, Float slack, Vec3 p, Vec3 q) {
  const Float zero(Real(0)), one(Real(1));
  const Float x = p.x - ref.middle.x, y = p.y - ref.middle.y, dx = q.x - p.x, dy = q.y - p.y;
  const Float a = max(fma(dx, dx, dy * dy), Real(1e-20)), b = fma(x, dx, y * dy);
  const Float c = fms(x, x, square(ref.radius + slack)) + y * y;
  const Float rest = fms(b, b, a * c), root = sqrt(max(rest, zero)), inv = one / a;
  const Float enter = max(-(b + root) * inv, zero), leave = min((root - b) * inv, one);
  return {min(enter, one), max(leave, zero), (zero <= rest) & (enter <= leave)};
}

// The part of incident edge from p to q over the face, at most two points.
void clip_edge(const Outline& ref, Float slack, Vec3 p, Vec3 q, Mask edge, Clipped& out) {
  const Float away(kOutOfReach);
  const Stretch s = ref.disc ? over_disc(ref, slack, p, q) : over_sides(ref, slack, p, q);
  const Vec3 first = fma(q - p, s.enter, p), last = fma(q - p, s.leave, p);
  const Mask there = edge & s.there;
  out.add(first.x, first.y, select(there, first.z, away));
  out.add(last.x, last.y, select(there, last.z, away));
}

// The corners of the face under (over) the incident face, whose normal is n in the same frame.
void cover_corners(const Outline& ref, const Outline& incident, Vec3 n, Mask face, Float slack,
                   Clipped& out) {
  const Float away(kOutOfReach), steep(Real(0.05));
  Mask usable = face & (n.z < -steep);
  // Of two caps the four points of the smaller do, always the same ones.
  if (ref.disc && incident.disc) {
    usable = usable & (ref.radius * Float(Real(1.01)) < incident.radius);
  }
  if (!any(usable)) return;
  const Float inv = Float(Real(1)) / select(usable, n.z, Float(Real(-1)));
  const Vec3 base = incident.corner[0];
  for (int j = 0; j < ref.count; ++j) {
    const Vec3 c = ref.corner[j];
    const Float z = fnma(fma(n.x, c.x - base.x, n.y * (c.y - base.y)), inv, base.z);
    Mask covered = usable;
    if (incident.disc) {
      const Vec3 reach = Vec3{c.x, c.y, z} - incident.middle;
      covered = covered & (dot(reach, reach) <= square(incident.radius + slack));
    }
    for (int i = 0; i < incident.count && !incident.disc; ++i) {
      // Seen from the reference face the incident outline runs clockwise.
      const Side side = side_of(incident, i, -slack);
      covered = covered & (-side.outside(c.x, c.y) <= Float(Real(0)));
    }
    out.add(c.x, c.y, select(covered, z, away));
  }
}

// The place of the deepest point, where it is clearly deeper than all candidates: it may be on none
// of the incident face's edges, or on the rim of a cap between its four points. `there`: lanes in
// which it is known.
void add_deepest(const Outline& ref, bool bounded, Vec3 found, Mask there, Float clearly,
                 Clipped& out) {
  Float least = Real(kOutOfReach);
  for (int i = 0; i < out.size; ++i) least = min(out.z[i], least);
  Mask over = there & (found.z + clearly < least);
  const Float slack = sqrt(ref.extent2) * Float(Real(0.05));
  if (bounded && ref.disc) {
    const Float x = found.x - ref.middle.x, y = found.y - ref.middle.y;
    over = over & (fma(x, x, y * y) <= square(ref.radius + slack));
  } else if (bounded) {
    for (int i = 0; i < ref.count; ++i) {
      over = over & (side_of(ref, i, slack).outside(found.x, found.y) <= Float(Real(0)));
    }
  }
  out.add(found.x, found.y, select(over, found.z, Float(kOutOfReach)));
}

MW_INLINE void put_kept(const KeptPoints& kept, const Frame& f, Float radius, Mask flip, Vec3 d,
                        Mask use, Manifold<Isotropic, 4>& m) {
  const Float zero(Real(0)), half(Real(0.5));
  const Vec3 to_incident = select(flip, -d, d);
  for (int i = 0; i < 4; ++i) {
    const Float z = min(kept.z[i], Real(1e3)) - radius;
    const Vec3 base = fma(f.v, kept.y[i], f.u * kept.x[i]);
    const Vec3 on_ref = fma(f.n, fma(min(z, zero), half, f.height), base);
    const Vec3 on_inc = fma(f.n, max(z, z * half) + f.height, base) - to_incident;
    m.point_a[i] = select(use, select(flip, on_inc, on_ref), m.point_a[i]);
    m.point_b[i] = select(use, select(flip, on_ref, on_inc), m.point_b[i]);
    m.separation[i] = select(use, z, m.separation[i]);
    m.feature_x[i] = select(use, kept.x[i], m.feature_x[i]);
    m.feature_y[i] = select(use, kept.y[i], m.feature_y[i]);
    m.valid[i] = (use & kept.valid[i]) | ((!use) & m.valid[i]);
  }
}

// Clips one shape's feature against the face of the other, in the lanes of `use`: those in which
// the face is one of `ref`. Returns the lanes in which points were found.
Mask clip_on_face(const Constants& t, const ConvexShape& ref, const ConvexShape& inc,
                  const ConvexAxis& axis, Vec3 d, bool flip, Mask use, Manifold<Isotropic, 4>& m) {
  const Vec3 n = flip ? -axis.face_normal : axis.face_normal, d_r = flip ? -d : d;
  Feature face, other;
  feature_along(ref, n, Real(0), face);
  feature_along(inc, -n, Real(1e-5), other);
  const Frame frame = frame_of(n, face.along, dot(n, face.corner[0]));
  Outline outline, incident;
  bring(frame, ref, face, {Real(0), Real(0), Real(0)}, outline);
  bring(frame, inc, other, d_r, incident);
  const Float extent2 = min(outline.extent2, max(incident.extent2, outline.extent2 * Real(0.01)));
  const Float slack = sqrt(outline.extent2) * Float(kEdgeSlack);
  Clipped clipped;
  for (int i = 0; i < incident.count; ++i) {
    const int next = i + 1 < incident.count ? i + 1 : 0;
    if (incident.count == 2 && i == 1) break;
    // A line has one edge, and a corner that is repeated none.
    const Vec3 p = incident.corner[i], q = incident.corner[next];
    const Mask repeated = (p.x == q.x) & (p.y == q.y) & (p.z == q.z);
    const Mask edge = i == 0 ? mask_from_bits(kAllLanes) : other.face & !repeated;
    clip_edge(outline, slack, p, q, edge, clipped);
  }
  const Vec3 tilt{dot(frame.u, other.normal), dot(frame.v, other.normal),
                  dot(frame.n, other.normal)};
  cover_corners(outline, incident, tilt, other.face, slack, clipped);
  add_deepest(outline, true, frame.local(flip ? axis.on_a - d : axis.on_b), axis.touch,
              Float(t.face_bias) * Float(kClearly), clipped);
  KeptPoints kept;
  keep_four(clipped, Float(t.margin), extent2, kept);
  // Where all of it is much shallower than the search says, the shapes touch beside the face. A
  // tile is touched nowhere else than over its triangle.
  const Float reached = max(axis.separation, axis.face_separation);
  const Float allowed = fma(abs(reached), Real(0.05), t.face_bias);
  const Mask good = use & kept.valid[0] & ((kept.z[0] < reached + allowed) | !axis.touch);
  put_kept(kept, frame, inc.radius, flip ? mask_from_bits(kAllLanes) : mask_from_bits(0), d, good,
           m);
  m.tangent = select(good, frame.u, m.tangent);
  m.normal = select(good, axis.face_normal, m.normal);
  const Float side = flip ? Real(1) : Real(0);
  m.code = select(good, fma(fma(axis.face, Real(2), side), Real(128), other.code), m.code);
  m.match_distance2 =
      select(good, match_distance2(sqrt(extent2) * Float(Real(0.7))), m.match_distance2);
  return good;
}

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

// Leaves an axis only normals that the tile's surface has; its own where there is another. The
// point that is deepest along that may be beside the triangle, and nothing touches there.
void keep_to_surface(const Tile& tile, const ConvexShape& b, Vec3 d, ConvexAxis& axis) {
  const Vec3 n = tile.normal;
  const Vec3 lowest = support(b, -n) + d;
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
  axis.face = select(other_face, Float(Real(0)), axis.face);
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
  if (is_line(a.kind) && is_line(b.kind)) put_lines(a, b, axis, d, active, m);
  // Faces win near ties. What is round around its core shows where the core is apart: there only
  // rounding is a tie.
  const Float face = axis.face_separation, other = axis.separation;
  const bool round = b.kind == ShapeKind::capsule;
  const Real rounding = sizeof(Real) == 4 ? Real(4e-6) : Real(1e-13);
  const Float size = sqrt(dot(d, d));
  const Float best_apart = max(face, zero);
  const Mask apart = zero <= other;
  Mask worse = fma(face, Real(0.95), t.face_bias) < other;
  if (round) {
    worse = (worse & !apart) | (apart & (best_apart + size * Float(rounding) < other));
  } else {
    worse = worse & ((!apart) | (best_apart < other));
  }
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
  add_deepest(outline, false, frame.local(support(b, -a.normal)), mask_from_bits(kAllLanes),
              Float(t.face_bias) * Float(kClearly), points);
  KeptPoints kept;
  keep_four(points, Float(Real(1e4)), outline.extent2, kept);
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
  const Vec3 lowest = support(b, -a.normal);
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
