// Clips one convex shape's feature against a face of the other: each of its edges against all sides
// of the face, and the corners of the face that lie under it. Four points are kept as for boxes.
#pragma once

#include "kernels/collide/outline.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

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
inline void clip_edge(const Outline& ref, Float slack, Vec3 p, Vec3 q, Mask edge, Clipped& out) {
  const Float away(kOutOfReach);
  const Stretch s = ref.disc ? over_disc(ref, slack, p, q) : over_sides(ref, slack, p, q);
  const Vec3 first = fma(q - p, s.enter, p), last = fma(q - p, s.leave, p);
  const Mask there = edge & s.there;
  out.add(first.x, first.y, select(there, first.z, away));
  out.add(last.x, last.y, select(there, last.z, away));
}

// The corners of the face under (over) the incident face, whose normal is n in the same frame.
inline void cover_corners(const Outline& ref, const Outline& incident, Vec3 n, Mask face,
                          Float slack, Clipped& out) {
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
inline void add_deepest(const Outline& ref, bool bounded, Vec3 found, Mask there, Float clearly,
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

// The height of a face in a frame whose normal it need not have.
struct FacePlane {
  Float slope_x, slope_y, base;
  MW_INLINE Float at(Float x, Float y) const { return fma(slope_x, x, fma(slope_y, y, base)); }
};

MW_INLINE void put_kept(const KeptPoints& kept, const Frame& f, const FacePlane& face, Float radius,
                        Mask flip, Vec3 d, Mask use, int first, Manifold<Isotropic, 4>& m) {
  const Float zero(Real(0)), half(Real(0.5));
  const Vec3 to_incident = select(flip, -d, d);
  for (int i = first; i < 4; ++i) {
    const Float z = min(kept.z[i], Real(1e3)) - radius;
    const Vec3 base = fma(f.v, kept.y[i], f.u * kept.x[i]);
    const Float height = f.height + face.at(kept.x[i], kept.y[i]);
    const Vec3 on_ref = fma(f.n, fma(min(z, zero), half, height), base);
    const Vec3 on_inc = fma(f.n, max(z, z * half) + height, base) - to_incident;
    m.point_a[i] = select(use, select(flip, on_inc, on_ref), m.point_a[i]);
    m.point_b[i] = select(use, select(flip, on_ref, on_inc), m.point_b[i]);
    m.separation[i] = select(use, z, m.separation[i]);
    m.feature_x[i] = select(use, kept.x[i], m.feature_x[i]);
    m.feature_y[i] = select(use, kept.y[i], m.feature_y[i]);
    m.valid[i] = (use & kept.valid[i]) | ((!use) & m.valid[i]);
    m.guard[i] = (use & kept.guard[i]) | (m.guard[i] & !use);
  }
}

// A feature of one shape over a face of the other, in a frame.
struct FacePair {
  Frame frame;
  Feature face, other;
  Outline outline, incident;
  Float extent2;
};
// What looks along n of `ref`, and against it of `inc`.
inline void find_features(const ConvexShape& ref, const ConvexShape& inc, Vec3 n, FacePair& p) {
  feature_along(ref, n, Real(0), p.face);
  feature_along(inc, -n, Real(1e-5), p.other);
}
inline void bring_together(const ConvexShape& ref, const ConvexShape& inc, Vec3 d_r, bool oblique,
                           FacePair& p) {
  bring(p.frame, ref, p.face, {Real(0), Real(0), Real(0)}, p.outline);
  bring(p.frame, inc, p.other, d_r, p.incident);
  // A disc is one in its own frame alone; elsewhere its four points stand for it.
  if (oblique) p.outline.disc = false;
  p.extent2 = min(p.outline.extent2, max(p.incident.extent2, p.outline.extent2 * Real(0.01)));
}
inline void collect_points(const FacePair& p, Clipped& clipped) {
  const Float slack = sqrt(p.outline.extent2) * Float(kEdgeSlack);
  const Outline& incident = p.incident;
  for (int i = 0; i < incident.count; ++i) {
    const int next = i + 1 < incident.count ? i + 1 : 0;
    if (incident.count == 2 && i == 1) break;
    // A line has one edge, and a corner that is repeated none.
    const Vec3 from = incident.corner[i], to = incident.corner[next];
    const Mask repeated = (from.x == to.x) & (from.y == to.y) & (from.z == to.z);
    const Mask edge = i == 0 ? mask_from_bits(kAllLanes) : p.other.face & !repeated;
    clip_edge(p.outline, slack, from, to, edge, clipped);
  }
  const Vec3 tilt{dot(p.frame.u, p.other.normal), dot(p.frame.v, p.other.normal),
                  dot(p.frame.n, p.other.normal)};
  cover_corners(p.outline, incident, tilt, p.other.face, slack, clipped);
}

// Codes of hulls' faces, two of which have at most 24 bits, begin beyond those of other manifolds.
// Tiles have one face.
inline constexpr Real kHullCode = 1e5, kHullOnTileCode = 256;

// Clips one shape's feature against the face of the other, in the lanes of `use`: those in which
// the face is one of `ref`. Returns the lanes in which points were found.
inline Mask clip_on_face(const Constants& t, const ConvexShape& ref, const ConvexShape& inc,
                         const ConvexAxis& axis, Vec3 d, bool flip, Mask use,
                         Manifold<Isotropic, 4>& m) {
  const Vec3 n = flip ? -axis.face_normal : axis.face_normal;
  FacePair p;
  find_features(ref, inc, n, p);
  p.frame = frame_of(n, p.face.along, dot(n, p.face.corner[0]));
  bring_together(ref, inc, flip ? -d : d, false, p);
  Clipped clipped;
  collect_points(p, clipped);
  add_deepest(p.outline, true, p.frame.local(flip ? axis.on_a - d : axis.on_b), axis.touch,
              Float(t.face_bias) * Float(kClearly), clipped);
  KeptPoints kept;
  keep_four(clipped, Float(t.margin), Float(t.margin * kLevel), p.extent2, kept);
  // Where all of it is much shallower than the search says, the shapes touch beside the face. A
  // tile is touched nowhere else than over its triangle.
  const Float reached = max(axis.separation, axis.face_separation);
  const Float allowed = fma(abs(reached), Real(0.05), t.face_bias);
  const Mask good = use & kept.valid[0] & ((kept.z[0] < reached + allowed) | !axis.touch);
  const FacePlane flat{Real(0), Real(0), Real(0)};
  put_kept(kept, p.frame, flat, inc.radius, flip ? mask_from_bits(kAllLanes) : mask_from_bits(0), d,
           good, 0, m);
  m.normal = select(good, axis.face_normal, m.normal);
  // Points, and the friction's directions, are told apart by A's feature even if B has the
  // reference face, so that impulses are carried over when it changes.
  const Frame of_a = flip ? frame_of(axis.face_normal, p.other.along, Real(0)) : p.frame;
  m.tangent = select(good, of_a.u, m.tangent);
  if (flip) put_places(of_a.u, of_a.v, good, m);
  const Float first = flip ? p.other.code : p.face.code, second = flip ? p.face.code : p.other.code;
  using K = kernels::ShapeKind;
  const bool hull = ref.kind == K::hull || inc.kind == K::hull;
  const bool tile = ref.kind == K::tile || inc.kind == K::tile;
  const Float code =
      hull ? fma(first, Real(4096), second) + Float(tile ? kHullOnTileCode : kHullCode)
           : fma(first, Real(128), second);
  m.code = select(good, code, m.code);
  m.match_distance2 =
      select(good, match_distance2(sqrt(p.extent2) * Float(Real(0.7))), m.match_distance2);
  return good;
}

// Guards (manifold.hpp) where an edge or a rim touches at one place, which the search found.
// Features of both that look along the normal are clipped as above, and heights are those along the
// normal between the two. `use`: lanes in which `ref` has the face that looks along it more.
inline constexpr Real kSteepFace = Real(0.2);  // the cosine to the normal, at least
inline constexpr Real kOffFace = Real(0.01);   // of the face's size

inline void clip_guards(const Constants& t, const ConvexShape& ref, const ConvexShape& inc,
                        const ConvexAxis& axis, Vec3 d, bool flip, Mask use,
                        Manifold<Isotropic, 4>& m) {
  const Vec3 n = flip ? -axis.normal : axis.normal;
  FacePair p;
  find_features(ref, inc, n, p);
  const Float cosine = dot(p.face.normal, n), one(Real(1));
  use = use & p.face.face & (Float(kSteepFace) < cosine);
  if (!any(use)) return;
  p.frame = frame_of(n, p.face.along, dot(n, flip ? axis.on_b - d : axis.on_a));
  bring_together(ref, inc, flip ? -d : d, true, p);
  const Float inv = one / select(use, cosine, one);
  const Vec3 corner = p.outline.corner[0];
  FacePlane plane{-(dot(p.frame.u, p.face.normal) * inv), -(dot(p.frame.v, p.face.normal) * inv),
                  Real(0)};
  plane.base = corner.z - plane.at(corner.x, corner.y);
  Clipped clipped;
  collect_points(p, clipped);
  for (int i = 0; i < clipped.size; ++i) {
    clipped.z[i] = clipped.z[i] - plane.at(clipped.x[i], clipped.y[i]);
  }
  const Vec3 found = p.frame.local(flip ? axis.on_a - d : axis.on_b);
  // The place that was found must be on that face, which a pointed hull's may not be.
  const Float off = plane.at(found.x, found.y), size = sqrt(p.extent2);
  use = use & (abs(off) < size * Float(kOffFace));
  clipped.add(found.x, found.y, axis.separation);
  KeptPoints kept;
  keep_four(clipped, Float(t.margin), Float(t.margin * kLevel), p.extent2, kept);
  const Mask good = use & kept.valid[0];
  put_kept(kept, p.frame, plane, inc.radius, flip ? mask_from_bits(kAllLanes) : mask_from_bits(0),
           d, good, 1, m);
  for (int k = 1; k < 4; ++k) m.guard[k] = m.guard[k] | (good & m.valid[k]);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
