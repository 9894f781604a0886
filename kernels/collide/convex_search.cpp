#include "kernels/collide/convex_search.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

constexpr int kRounds = 24;
// Where one shape is round all over the search never comes to a corner that it has been to.
constexpr int kRoundsOfCurved = 96;

}  // namespace

Corner corner_along(const ConvexShape& a, const ConvexShape& b, Vec3 d, Vec3 n, Mask lanes) {
  const Vec3 on_a = support(a, n, lanes);
  return {support(b, -n, lanes) + d - on_a, on_a};
}

namespace {

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
  const auto nearest = [&](const Corner& x, const Corner& y, const Corner& z) {
    return nearest_on_triangle(x.w - target, y.w - target, z.w - target);
  };
  Simplex out = s;
  Nearest best = nearest(s.x, s.y, s.z);
  const auto take = [&](const Corner& x, const Corner& y, const Corner& z) {
    const Nearest n = nearest(x, y, z);
    const Mask nearer = n.distance2 < best.distance2;
    out.x = select(nearer, x, out.x);
    out.y = select(nearer, y, out.y);
    out.z = select(nearer, z, out.z);
    best = {select(nearer, n.point, best.point), select(nearer, n.distance2, best.distance2),
            select(nearer, n.u, best.u), select(nearer, n.v, best.v), select(nearer, n.w, best.w)};
  };
  take(fresh, s.x, s.y), take(fresh, s.y, s.z), take(fresh, s.z, s.x);
  set_nearest(best, out);
  return out;
}

}  // namespace

void climb(const ConvexShape& a, const ConvexShape& b, Vec3 d, Float tolerance, Float limit,
           bool fixed_target, Mask going, Best& best, Simplex& s) {
  const Float zero(Real(0)), one(Real(1));
  const auto curved = [](const ConvexShape& c) {
    return info(c.kind).single && !info(c.kind).ball;
  };
  const int rounds = curved(a) || curved(b) ? kRoundsOfCurved : kRounds;
  s.x = s.y = s.z = corner_along(a, b, d, best.normal, going);
  Corner fresh = s.x;
  for (int round = 0; round < rounds; ++round) {
    const Vec3 target = best.normal * (fixed_target ? zero : min(best.separation, zero));
    s = select(going, add_corner(s, fresh, target), s);
    const Float distance = sqrt(s.distance2);
    going = going & (tolerance < distance - max(best.separation, zero));
    if (!any(going)) break;
    const Vec3 n = s.way * (one / max(distance, Real(1e-20)));
    fresh = corner_along(a, b, d, n, going);
    const Float separation = dot(n, fresh.w);
    const Mask better = going & (best.separation < separation);
    best.normal = select(better, n, best.normal);
    best.separation = select(better, separation, best.separation);
    // Nothing new and nothing better: that was it.
    const Mask old = same(fresh.w, s.x.w) | same(fresh.w, s.y.w) | same(fresh.w, s.z.w);
    going = going & (better | !old) & (best.separation < limit);
  }
}

void climb_again(const ConvexShape& a, const ConvexShape& b, Vec3 d, Float tolerance, Float limit,
                 Vec3 of_a, Vec3 of_b, Mask deep, Best& best, Simplex& s) {
  const Vec3 line = normalized(d, Real(1e-20), {Real(0), Real(0), Real(1)});
  const Vec3 starts[] = {line,
                         of_a,
                         of_b,
                         normalized(of_a + of_b, Real(1e-6), of_a),
                         normalized(of_a + line, Real(1e-6), line),
                         normalized(line + of_b, Real(1e-6), line)};
  for (const Vec3& n : starts) {
    Best other{n, dot(n, corner_along(a, b, d, n, deep).w)};
    Simplex there{};
    if (&n == starts) climb(a, b, d, tolerance, limit, true, deep, other, there);
    climb(a, b, d, tolerance, limit, false, deep, other, there);
    const Mask better = deep & (best.separation < other.separation);
    best.normal = select(better, other.normal, best.normal);
    best.separation = select(better, other.separation, best.separation);
    s = select(better, there, s);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
