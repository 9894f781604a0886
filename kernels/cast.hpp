// cast: a body that moves more than half its extent in a step is swept against the fixed shapes
// that are not planes, and stops where its core first touches one. Planes need no cast: contacts
// with a speculative margin hold at any speed against a half space.
//
// The core is a sphere inside the body about its centre of mass, smaller than the body, so that
// passing an edge closely is not an impact. The time of touch is found by conservative
// advancement: the core may always move by its distance to the shape. The rest of the step's
// motion is dropped; the velocity stays, and the next step's contact deals with it.
#pragma once

#include "kernels/lane/space.hpp"
#include "kernels/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kCastRounds = 32;

MW_INLINE Mask within_bounds(const Tables& t, Vec2 x) {
  return (Float(t.bounds_low[0]) <= x.x) & (x.x <= Float(t.bounds_high[0])) &
         (Float(t.bounds_low[1]) <= x.y) & (x.y <= Float(t.bounds_high[1]));
}
MW_INLINE Mask within_bounds(const Tables& t, Vec3 x) {
  return within_bounds(t, Vec2{x.x, x.y}) & (Float(t.bounds_low[2]) <= x.z) &
         (x.z <= Float(t.bounds_high[2]));
}

// Distance from a point to a fixed shape; 0 or less inside.
MW_INLINE Float distance_to_fixed(const Tables& t, const kernels::FixedTable<Real>& shape, Vec3 p) {
  const Real* r = t.fixed_rows + shape.row;
  const Float zero(Real(0));
  if (shape.kind == kernels::ShapeKind::sphere) {
    const Vec3 d = p - Vec3{r[0], r[1], r[2]};
    return sqrt(dot(d, d)) - Float(r[3]);
  }
  const Vec3 d = p - Vec3{r[3], r[7], r[11]};
  const Vec3 local{dot(d, Vec3{r[0], r[1], r[2]}), dot(d, Vec3{r[4], r[5], r[6]}),
                   dot(d, Vec3{r[8], r[9], r[10]})};
  const Vec3 out{max(abs(local.x) - Float(r[12]), zero), max(abs(local.y) - Float(r[13]), zero),
                 max(abs(local.z) - Float(r[14]), zero)};
  return sqrt(dot(out, out));
}
MW_INLINE Float distance_to_fixed(const Tables& t, const kernels::FixedTable<Real>& shape, Vec2 p) {
  const Real* r = t.fixed_rows + shape.row;
  const Float zero(Real(0));
  const Vec2 d = p - Vec2{r[0], r[1]};
  if (shape.kind == kernels::ShapeKind::circle) return sqrt(dot(d, d)) - Float(r[2]);
  if (shape.kind == kernels::ShapeKind::rectangle) {
    const Vec2 local = rotate_inverse({r[2], r[3]}, d);
    const Vec2 out{max(abs(local.x) - Float(r[4]), zero), max(abs(local.y) - Float(r[5]), zero)};
    return sqrt(dot(out, out));
  }
  // Convex polygon: the largest distance to an edge line is a lower bound, which is all that
  // conservative advancement needs; it is exact where it matters, in front of a face.
  Float far = Real(-1e30);
  for (int i = 0; i < kernels::kMaxVertices; ++i) {
    const Vec2 vertex{r[4 + 2 * i], r[5 + 2 * i]};
    const Vec2 normal{r[20 + 2 * i], r[21 + 2 * i]};
    far = max(far, dot(normal, d - vertex));
  }
  return far;
}

template <class S>
MW_INLINE typename S::Vec cast_against_fixed(const Tables& t, int body, typename S::Vec start,
                                             typename S::Vec step) {
  const auto& b = t.body[body];
  if (b.core_radius <= Real(0)) return step;
  const Float length = sqrt(dot(step, step));
  const Mask fast = Float(b.core_radius) < length;
  if (!any(fast)) return step;
  const Float zero(Real(0)), one(Real(1));
  // The core is half the inner sphere, so a body sunk into a face still counts as outside of it.
  const Float core(b.core_radius * Real(0.5));
  const Float inv_length = one / max(length, Real(1e-20));
  Float least = one;
  for (int f = 0; f < t.fixed_shapes; ++f) {
    const auto& shape = t.fixed[f];
    if (shape.kind == kernels::ShapeKind::plane) continue;
    Float fraction = zero;
    // Bodies that begin inside are the contact's business.
    Mask moving = fast & (core < distance_to_fixed(t, shape, start));
    const Mask candidate = moving;
    for (int round = 0; round < kCastRounds && any(moving); ++round) {
      const Float gap = distance_to_fixed(t, shape, fma(step, fraction, start)) - core;
      const Mask close = gap < core * Float(Real(0.01));
      const Float next = fma(gap, inv_length, fraction);
      moving = moving & !close;
      fraction = select(moving, min(next, one), fraction);
      moving = moving & (fraction < one);
    }
    least = select(candidate, min(least, fraction), least);
  }
  return select(least < one, step * least, step);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
