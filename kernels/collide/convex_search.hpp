// The search for the normal along which two convex shapes are farthest apart, or overlap least
// (convex_axes.cpp).
//
// With w = b - a for points b of B and a of A, s(n) = min over w of n . w is the separation along
// n; its largest value is wanted. From a candidate the search goes up hill. It is GJK, which looks
// for the point of all w nearest to a target, with a target that moves:
//
//   Let s be the best so far, along n. Apart (s > 0) the target is the origin, and this is GJK.
//   In overlap it is s n, the point of the best plane n . w = s nearest to the origin. If some w is
//   there, the plane touches at the very place that the origin is nearest to: nothing near is
//   better. If not, let c be the w nearest to it, m = (c - s n) / |c - s n|. Then
//   s(m) = m . c = |c - s n| + s m . n > s.
//
// What comes out is a separation along a direction that was looked at, so it is right whatever
// rounding did to the way there. In overlap the maximum may be a local one, near the candidate.
#pragma once

#include "kernels/collide/convex.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kNoLimit = Real(1e30);
inline constexpr Real kDeep = Real(0.004);  // of the shapes' size
inline constexpr Real kTolerance = sizeof(Real) == 4 ? Real(2e-6) : Real(1e-12);  // of their size

MW_INLINE Vec3 normalized(Vec3 v, Float least2, Vec3 otherwise) {
  const Float one(Real(1)), l2 = dot(v, v);
  const Mask real = least2 < l2;
  return select(real, v * (one / sqrt(select(real, l2, one))), otherwise);
}

// Of which tolerances are shares.
MW_INLINE Float size_of_pair(const ConvexShape& a, const ConvexShape& b, Vec3 d) {
  const auto largest = [](Vec3 v) { return max(max(v.x, v.y), v.z); };
  return sqrt(dot(d, d)) + min(largest(a.half), largest(b.half));
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
MW_INLINE Best select(Mask m, const Best& a, const Best& b) {
  return {select(m, a.normal, b.normal), select(m, a.separation, b.separation)};
}

// Along the faces of `s`; d: from its p to the other's. Normals point away from s.
void try_faces(const ConvexShape& s, const ConvexShape& other, Vec3 d, Mask lanes, Best& best);

MW_INLINE bool has_axis(kernels::ShapeKind kind) {
  return kind == kernels::ShapeKind::cylinder || kind == kernels::ShapeKind::capsule;
}

// Normals that no face has, to start from: along the line of centres and across axes.
void try_others(const ConvexShape& a, const ConvexShape& b, Vec3 d, Mask lanes, Best& best);

// find_convex_axis() where one is a hull (hull_axes.cpp).
void find_axis_of_hull(const Constants& t, const ConvexShape& a, const ConvexShape& b, Mask active,
                       ConvexAxis& out);

struct Corner {
  Vec3 w, a;  // b - a, and a; from A's p
};
MW_INLINE Corner select(Mask m, const Corner& a, const Corner& b) {
  return {select(m, a.w, b.w), select(m, a.a, b.a)};
}

Corner corner_along(const ConvexShape& a, const ConvexShape& b, Vec3 d, Vec3 n, Mask lanes);

// Three corners of the hull of all w, and what of them is nearest to the target.
struct Simplex {
  Corner x, y, z;
  Vec3 way;  // from the target to the nearest point
  Float distance2;
  Vec3 on_a, on_b;
};

// Goes up hill from `best` in the lanes of `going`, until its separation reaches `limit`; s: what
// it stood on in the end. With a fixed target, the origin, it finds out whether the shapes are
// apart.
void climb(const ConvexShape& a, const ConvexShape& b, Vec3 d, Float tolerance, Float limit,
           bool fixed_target, Mask going, Best& best, Simplex& s);

// Deep in one another there are several hills: climbs from other normals, too, in the lanes of
// `deep`. Those are the line of centres, which shows first whether the shapes are apart, a normal
// of each shape from A to B, and what is between two of these.
void climb_again(const ConvexShape& a, const ConvexShape& b, Vec3 d, Float tolerance, Float limit,
                 Vec3 of_a, Vec3 of_b, Mask deep, Best& best, Simplex& s);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
