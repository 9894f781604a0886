// Box against box where an edge of one touches an edge of the other: one point, half way between
// the nearest points of the two, and guards where the boxes turn on to next. Those are what is
// clipped of the faces that look along the normal more than others; heights over the face are gaps
// along the normal by the cosine between the two.
#pragma once

#include "kernels/collide/box_faces.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kGuardApart2 = Real(0.04);  // of the smaller face: what is a place of its own

struct EdgeContact {
  Vec3 normal, along_a;
  Vec3 on_a, on_b;  // from A's centre
  Float gap;
  Float face;      // axis of the box whose face looks along the normal more
  Mask face_of_b;  // that box
};

// The axis of a box nearest to n.
struct AlignedAxis {
  Float axis, cosine;
};
MW_INLINE AlignedAxis aligned_axis(const BoxPose& box, Vec3 n) {
  const Vec3 r[3] = {box.r.x, box.r.y, box.r.z};
  AlignedAxis out{Real(0), abs(dot(r[0], n))};
  for (int k = 1; k < 3; ++k) {
    const Float cosine = abs(dot(r[k], n));
    const Mask better = out.cosine < cosine;
    out = {select(better, Float(static_cast<Real>(k)), out.axis), max(cosine, out.cosine)};
  }
  return out;
}

// Nearest points of edge i of A and edge j of B, chosen towards each other.
MW_INLINE EdgeContact edge_contact(const BoxPose& a, const BoxPose& b, Vec3 d, Float axis) {
  const Float zero(Real(0)), one(Real(1)), three(Real(3));
  const Float code = max(axis - Float(Real(6)), zero);
  const Float i = select(code < three, zero, select(code < Float(Real(6)), one, Float(Real(2))));
  const Float j = fnma(i, three, code);
  const Vec3 along_a = pick(i, a.r), along_b = pick(j, b.r);
  Vec3 n = cross(along_a, along_b);
  n = n * (one / sqrt(max(dot(n, n), Real(1e-8))));
  n = n * copysign(one, dot(n, d));
  const Vec3 ra[3] = {a.r.x, a.r.y, a.r.z}, rb[3] = {b.r.x, b.r.y, b.r.z};
  const Float ha[3] = {a.half.x, a.half.y, a.half.z}, hb[3] = {b.half.x, b.half.y, b.half.z};
  Vec3 pa{zero, zero, zero}, pb = d;
  for (int k = 0; k < 3; ++k) {
    const Float index(static_cast<Real>(k));
    const Float step_a = select(i == index, zero, copysign(ha[k], dot(n, ra[k])));
    const Float step_b = select(j == index, zero, copysign(hb[k], dot(n, rb[k])));
    pa = fma(ra[k], step_a, pa);
    pb = fnma(rb[k], step_b, pb);
  }
  const Vec3 w = pb - pa;
  const Float cosine = dot(along_a, along_b);
  const Float wa = dot(along_a, w), wb = -dot(along_b, w);
  const Float inv = one / max(fnma(cosine, cosine, one), Real(1e-4));
  EdgeContact out;
  out.normal = n;
  out.along_a = along_a;
  out.on_a = fma(along_a, fma(cosine, wb, wa) * inv, pa);
  out.on_b = fma(along_b, fma(cosine, wa, wb) * inv, pb);
  out.gap = dot(n, w);
  const AlignedAxis of_a = aligned_axis(a, n), of_b = aligned_axis(b, n);
  out.face_of_b = of_a.cosine < of_b.cosine;
  out.face = select(out.face_of_b, of_b.axis, of_a.axis);
  return out;
}

// `kept`: of the face `f` of B in the lanes of `from_b`, else of A, in the lanes of `use`.
template <class S>
MW_INLINE void put_edge_contact(const EdgeContact& e, Float axis, Vec3 d, Mask from_b,
                                const FaceFrame& f, const KeptPoints& kept, Float extent2, Mask use,
                                Manifold<S, 4>& m) {
  const Float zero(Real(0)), one(Real(1));
  m.normal = select(use, e.normal, m.normal);
  m.tangent = select(use, e.along_a, m.tangent);
  // Apart, each body keeps its own point; in overlap they share the middle.
  const Vec3 middle = (e.on_a + e.on_b) * Float(Real(0.5));
  const Mask apart = zero < e.gap;
  m.point_a[0] = select(use, select(apart, e.on_a, middle), m.point_a[0]);
  m.point_b[0] = select(use, select(apart, e.on_b, middle) - d, m.point_b[0]);
  m.separation[0] = select(use, e.gap, m.separation[0]);
  m.valid[0] = m.valid[0] | use;
  m.guard[0] = m.guard[0] & !use;
  m.feature_x[0] = select(use, zero, m.feature_x[0]);
  m.feature_y[0] = select(use, zero, m.feature_y[0]);
  m.code = select(use, axis * Float(Real(8)), m.code);

  const Vec3 origin = select(from_b, d, zero_of<Vec3>()), found = middle - origin;
  const Float x0 = dot(f.u, found), y0 = dot(f.v, found);
  const Float inv = one / max(abs(dot(f.n, e.normal)), Float(Real(0.5)));  // of a box 1 / sqrt(3)
  // Of the four the one nearest to the point itself is left out.
  Float distance2[4], nearest = Real(1e30), skip = zero;
  for (int i = 0; i < 4; ++i) {
    const Float dx = kept.x[i] - x0, dy = kept.y[i] - y0;
    distance2[i] = fma(dx, dx, dy * dy);
    const Mask nearer = distance2[i] < nearest;
    nearest = min(distance2[i], nearest);
    skip = select(nearer, Float(static_cast<Real>(i)), skip);
  }
  for (int i = 1; i < 4; ++i) {
    const Mask next = skip < Float(static_cast<Real>(i));  // the kept point i, else i - 1
    const Float x = select(next, kept.x[i], kept.x[i - 1]),
                y = select(next, kept.y[i], kept.y[i - 1]);
    const Float z = select(next, kept.z[i], kept.z[i - 1]);
    const Mask there = (next & kept.valid[i]) | (kept.valid[i - 1] & !next);
    const Mask own = extent2 * Float(kGuardApart2) < select(next, distance2[i], distance2[i - 1]);
    const Vec3 place = fma(f.n, f.height + min(z, Real(1e3)), fma(f.v, y, f.u * x)) + origin;
    m.point_a[i] = select(use, place, m.point_a[i]);
    m.point_b[i] = select(use, place - d, m.point_b[i]);
    m.separation[i] = select(use, max(min(z, Real(1e3)) * inv, e.gap), m.separation[i]);
    m.valid[i] = (m.valid[i] & !use) | (use & there & own);
    m.guard[i] = (m.guard[i] & !use) | (use & there & own);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
