// The normal along which two convex shapes are farthest apart, or overlap least.
//
// With w = b - a for points b of B and a of A, s(n) = min over w of n . w is the separation along
// n; its largest value is wanted. Candidates come first: the faces' normals of both and a few that
// round shapes have. From the best of them a search goes up hill. It is GJK, which looks for the
// point of all w nearest to a target, with a target that moves:
//
//   Let s be the best so far, along n. Apart (s > 0) the target is the origin, and this is GJK.
//   In overlap it is s n, the point of the best plane n . w = s nearest to the origin. If some w is
//   there, the plane touches at the very place that the origin is nearest to: nothing near is
//   better. If not, let c be the w nearest to it, m = (c - s n) / |c - s n|. Then
//   s(m) = m . c = |c - s n| + s m . n > s.
//
// What comes out is a separation along a direction that was looked at, so it is right whatever
// rounding did to the way there. In overlap the maximum may be a local one, near the best
// candidate.
#include "kernels/collide/convex.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::ShapeKind;

constexpr int kRounds = 24;
// Where one shape is round all over the search never comes to a corner that it has been to.
constexpr int kRoundsOfCurved = 96;
constexpr Real kDeep = Real(0.004);                                        // of the shapes' size
constexpr Real kTolerance = sizeof(Real) == 4 ? Real(2e-6) : Real(1e-12);  // of the shapes' size

MW_INLINE Vec3 normalized(Vec3 v, Float least2, Vec3 otherwise) {
  const Float one(Real(1)), l2 = dot(v, v);
  const Mask real = least2 < l2;
  return select(real, v * (one / sqrt(select(real, l2, one))), otherwise);
}

// ---- candidates --------------------------------------------------------------------------------

// Takes `index` of the faces of s when it is better; `flip`: s is B.
struct BestFace {
  Vec3 normal;
  Float separation, index;
  MW_INLINE void take(Vec3 n, Float s, int i) {
    const Mask better = separation < s;
    separation = max(s, separation);
    normal = select(better, n, normal);
    index = select(better, Float(static_cast<Real>(i)), index);
  }
};

// Along the faces of `s`; d: from its p to the other's. Normals point away from s.
void try_faces(const ConvexShape& s, const ConvexShape& other, Vec3 d, BestFace& best) {
  if (s.kind == ShapeKind::hull) {
    const Vec3 inverse = inverse_of(s.half);
    for (int i = 0; i < s.faces.most; ++i) {
      const HullFace face = hull_face(s.faces, s.r, inverse, i);
      best.take(face.normal,
                dot(face.normal, d) + extent_along(other, face.normal).low - face.reach, i);
    }
    return;
  }
  if (s.kind == ShapeKind::tile) {
    const Vec3 n = s.face_normal;
    best.take(n, dot(n, d - s.vertex[0]) + extent_along(other, n).low, 0);
    return;
  }
  const auto both_sides = [&](Vec3 axis, Float half, int i) {
    const Extent e = extent_along(other, axis);
    const Float along = dot(axis, d);
    best.take(axis, along + e.low - half, 2 * i);
    best.take(-axis, -(along + e.high) - half, 2 * i + 1);
  };
  if (s.kind == ShapeKind::box) {
    both_sides(s.r.x, s.half.x, 0);
    both_sides(s.r.y, s.half.y, 1);
  }
  if (s.kind == ShapeKind::box || s.kind == ShapeKind::cylinder) both_sides(s.r.z, s.half.z, 2);
}

struct Best {
  Vec3 normal;
  Float separation;
  MW_INLINE void take(Vec3 n, Float s) {
    const Mask better = separation < s;
    separation = max(s, separation);
    normal = select(better, n, normal);
  }
};

MW_INLINE bool has_axis(ShapeKind kind) {
  return kind == ShapeKind::cylinder || kind == ShapeKind::capsule;
}

// Normals that no face has, to start from: along the line of centres and across axes.
void try_others(const ConvexShape& a, const ConvexShape& b, Vec3 d, Best& best) {
  const Float one(Real(1)), least(Real(1e-6));
  const auto look = [&](Vec3 n) {
    n = n * copysign(one, dot(n, d));
    best.take(n, dot(n, d) + extent_along(b, n).low - extent_along(a, n).high);
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

// ---- search ------------------------------------------------------------------------------------

struct Corner {
  Vec3 w, a;  // b - a, and a; from A's p
};
MW_INLINE Corner select(Mask m, const Corner& a, const Corner& b) {
  return {select(m, a.w, b.w), select(m, a.a, b.a)};
}

Corner corner_along(const ConvexShape& a, const ConvexShape& b, Vec3 d, Vec3 n) {
  const Vec3 on_a = support(a, n);
  return {support(b, -n) + d - on_a, on_a};
}

// The point of a triangle nearest to the origin, as weights of its corners.
struct Nearest {
  Vec3 point;
  Float distance2, u, v, w;
};
Nearest nearest_on_triangle(Vec3 a, Vec3 b, Vec3 c) {
  const Float zero(Real(0)), one(Real(1)), least(Real(1e-30));
  const Vec3 ab = b - a, ac = c - a, bc = c - b;
  const auto share = [&](Vec3 from, Vec3 way) {
    return clamp(-dot(from, way) / max(dot(way, way), least), zero, one);
  };
  Float s = share(a, ab);
  Nearest best{fma(ab, s, a), zero, one - s, s, zero};
  best.distance2 = dot(best.point, best.point);
  const auto take = [&](Mask better, Vec3 point, Float d2, Float u, Float v, Float w) {
    best.point = select(better, point, best.point);
    best.distance2 = select(better, d2, best.distance2);
    best.u = select(better, u, best.u);
    best.v = select(better, v, best.v);
    best.w = select(better, w, best.w);
  };
  s = share(a, ac);
  Vec3 p = fma(ac, s, a);
  Float d2 = dot(p, p);
  take(d2 < best.distance2, p, d2, one - s, zero, s);
  s = share(b, bc);
  p = fma(bc, s, b);
  d2 = dot(p, p);
  take(d2 < best.distance2, p, d2, zero, one - s, s);
  // Over its inside, where it has one.
  const Vec3 n = cross(ab, ac);
  const Float nn = dot(n, n), thin(sizeof(Real) == 4 ? Real(1e-7) : Real(1e-18));
  const Float v = dot(n, cross(ac, a)), w = dot(n, cross(a, ab)), u = nn - v - w;
  const Mask inside =
      (thin * dot(ab, ab) * dot(ac, ac) < nn) & (zero <= u) & (zero <= v) & (zero <= w);
  const Float inv = one / select(inside, nn, one);
  p = n * (dot(n, a) * inv);
  d2 = dot(p, p);
  take(inside & (d2 <= best.distance2), p, d2, u * inv, v * inv, w * inv);
  return best;
}

MW_INLINE Mask same(Vec3 a, Vec3 b) { return (a.x == b.x) & (a.y == b.y) & (a.z == b.z); }

// Three corners of the hull of all w, and what of them is nearest to the target.
struct Simplex {
  Corner x, y, z;
  Vec3 way;  // from the target to the nearest point
  Float distance2;
  Vec3 on_a, on_b;
};

void set_nearest(const Nearest& at, Simplex& s) {
  s.way = at.point;
  s.distance2 = at.distance2;
  s.on_a = fma(s.z.a, at.w, fma(s.y.a, at.v, s.x.a * at.u));
  s.on_b = s.on_a + fma(s.z.w, at.w, fma(s.y.w, at.v, s.x.w * at.u));
}

Simplex select(Mask m, const Simplex& a, const Simplex& b) {
  return {select(m, a.x, b.x),
          select(m, a.y, b.y),
          select(m, a.z, b.z),
          select(m, a.way, b.way),
          select(m, a.distance2, b.distance2),
          select(m, a.on_a, b.on_a),
          select(m, a.on_b, b.on_b)};
}

// Of the four triangles of the simplex and a new corner the one nearest to the target.
Simplex add_corner(const Simplex& s, const Corner& fresh, Vec3 target) {
  const Corner corner[4] = {s.x, s.y, s.z, fresh};
  constexpr int kTriangle[4][3] = {{0, 1, 2}, {3, 0, 1}, {3, 1, 2}, {3, 2, 0}};
  Simplex out{};
  Nearest best{};
  for (int i = 0; i < 4; ++i) {
    const Corner &x = corner[kTriangle[i][0]], &y = corner[kTriangle[i][1]],
                 &z = corner[kTriangle[i][2]];
    const Nearest n = nearest_on_triangle(x.w - target, y.w - target, z.w - target);
    const Mask nearer = i == 0 ? mask_from_bits(kAllLanes) : n.distance2 < best.distance2;
    out.x = select(nearer, x, out.x);
    out.y = select(nearer, y, out.y);
    out.z = select(nearer, z, out.z);
    best = {select(nearer, n.point, best.point), select(nearer, n.distance2, best.distance2),
            select(nearer, n.u, best.u), select(nearer, n.v, best.v), select(nearer, n.w, best.w)};
  }
  set_nearest(best, out);
  return out;
}

// Goes up hill from `best` in the lanes of `going`; s: what it stood on in the end. With a fixed
// target, the origin, it finds out whether the shapes are apart.
void climb(const ConvexShape& a, const ConvexShape& b, Vec3 d, Float tolerance, bool fixed_target,
           Mask going, Best& best, Simplex& s) {
  const Float zero(Real(0)), one(Real(1));
  const auto curved = [](const ConvexShape& c) {
    return info(c.kind).single && !info(c.kind).ball;
  };
  const int rounds = curved(a) || curved(b) ? kRoundsOfCurved : kRounds;
  s.x = s.y = s.z = corner_along(a, b, d, best.normal);
  Corner fresh = s.x;
  for (int round = 0; round < rounds; ++round) {
    const Vec3 target = best.normal * (fixed_target ? zero : min(best.separation, zero));
    s = select(going, add_corner(s, fresh, target), s);
    const Float distance = sqrt(s.distance2);
    going = going & (tolerance < distance - max(best.separation, zero));
    if (!any(going)) break;
    const Vec3 n = s.way * (one / max(distance, Real(1e-20)));
    fresh = corner_along(a, b, d, n);
    const Float separation = dot(n, fresh.w);
    const Mask better = going & (best.separation < separation);
    best.normal = select(better, n, best.normal);
    best.separation = select(better, separation, best.separation);
    // Nothing new and nothing better: that was it.
    const Mask old = same(fresh.w, s.x.w) | same(fresh.w, s.y.w) | same(fresh.w, s.z.w);
    going = going & (better | !old);
  }
}

}  // namespace

void find_convex_axis(const Constants& t, const ConvexShape& a, const ConvexShape& b, Mask active,
                      ConvexAxis& out) {
  const Float zero(Real(0)), one(Real(1)), never(Real(-1e30));
  const Vec3 d = b.p - a.p;
  const Vec3 up{zero, zero, one};
  BestFace of_a{up, never, zero}, of_b{up, never, zero};
  try_faces(a, b, d, of_a);
  try_faces(b, a, -d, of_b);
  out.face_of_b = of_a.separation + Float(t.face_tie) < of_b.separation;
  out.face_of_b = out.face_of_b | (max(of_a.separation, zero) < of_b.separation);
  out.face_separation = select(out.face_of_b, of_b.separation, of_a.separation);
  out.face_normal = select(out.face_of_b, -of_b.normal, of_a.normal);
  out.face = select(out.face_of_b, of_b.index, of_a.index);
  Best best{out.face_normal, out.face_separation};
  best.take(of_a.normal, of_a.separation);
  try_others(a, b, d, best);
  out.near = active & (best.separation < a.margin + b.margin);

  const Float size = sqrt(dot(d, d)) + min(max(max(a.half.x, a.half.y), a.half.z),
                                           max(max(b.half.x, b.half.y), b.half.z));
  const Float tolerance = size * Float(kTolerance);
  Simplex s{};
  if (any(out.near)) climb(a, b, d, tolerance, false, out.near, best, s);
  // Deep in one another there are several hills.
  const Mask deep = out.near & (best.separation < size * Float(-kDeep));
  if (any(deep)) {
    const Vec3 line = normalized(d, Real(1e-20), up);
    const Vec3 starts[] = {line,
                           of_a.normal,
                           -of_b.normal,
                           normalized(of_a.normal - of_b.normal, Real(1e-6), of_a.normal),
                           normalized(of_a.normal + line, Real(1e-6), line),
                           normalized(line - of_b.normal, Real(1e-6), line)};
    for (const Vec3& n : starts) {
      Best other{n, dot(n, corner_along(a, b, d, n).w)};
      Simplex there{};
      if (&n == starts) climb(a, b, d, tolerance, true, deep, other, there);
      climb(a, b, d, tolerance, false, deep, other, there);
      const Mask better = deep & (best.separation < other.separation);
      best.normal = select(better, other.normal, best.normal);
      best.separation = select(better, other.separation, best.separation);
      s = select(better, there, s);
    }
  }
  out.normal = best.normal;
  out.separation = best.separation;
  out.on_a = s.on_a;
  out.on_b = s.on_b;
  out.touch = mask_from_bits(kAllLanes);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
