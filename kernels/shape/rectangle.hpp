// Rectangles: pose row, bounds, rays, distance, corners.
#pragma once

#include "kernels/shape/corners.hpp"
#include "kernels/shape/placement.hpp"
#include "kernels/shape/ray.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct RectanglePose {
  static constexpr auto kKind = kernels::ShapeKind::rectangle;
  Vec2 p;
  Rot2 q;
  Vec2 half;

  static MW_INLINE BoundsOf<Vec2> put(const PlanarPlacement& s) {
    const Rot2 q = s.r;
    const Float hx(s.constants.half[0]), hy(s.constants.half[1]);
    store_rows4(s.rows, s.offset, s.p.x, s.p.y, q.c, q.s);
    store_rows4(s.rows + 4, s.offset, hx, hy, Real(0), Real(0));
    return {
        s.p,
        {fma(abs(q.s), hy, abs(q.c) * hx) + s.margin, fma(abs(q.c), hy, abs(q.s) * hx) + s.margin}};
  }
};

MW_INLINE void load_pose(const Real* base, const std::int32_t* o, RectanglePose& r) {
  Float unused0, unused1;
  load_rows4(base, o, r.p.x, r.p.y, r.q.c, r.q.s);
  load_rows4(base + 4, o, r.half.x, r.half.y, unused0, unused1);
}

MW_INLINE RayHit<Vec2> cast(const RayOf<Vec2>& ray, const RectanglePose& r) {
  const Vec2 place = rotate_inverse(r.q, ray.from - r.p), way = rotate_inverse(r.q, ray.way);
  const Vec2 x{r.q.c, r.q.s}, y{-r.q.s, r.q.c};
  Clip clip;
  Vec2 normal = x;
  clip_slab(clip, x, place.x, way.x, r.half.x, normal);
  clip_slab(clip, y, place.y, way.y, r.half.y, normal);
  return clipped(ray, clip, normal);
}

MW_INLINE Float distance2_from(const RectanglePose& r, Vec2 p) {
  const Float zero(Real(0));
  const Vec2 local = rotate_inverse(r.q, p - r.p);
  const Vec2 out{max(abs(local.x) - r.half.x, zero), max(abs(local.y) - r.half.y, zero)};
  return dot(out, out);
}

// How far two rectangles are apart along the axes of either, < 0: by how much they overlap.
struct RectangleAxes {
  Float ax, ay, bx, by;
};
MW_INLINE RectangleAxes separations(const RectanglePose& a, const RectanglePose& b) {
  const Vec2 d = b.p - a.p;
  const Vec2 in_a = rotate_inverse(a.q, d), in_b = rotate_inverse(b.q, d);
  const Float c = abs(fma(a.q.c, b.q.c, a.q.s * b.q.s));
  const Float s = abs(fms(a.q.c, b.q.s, a.q.s * b.q.c));
  return {abs(in_a.x) - a.half.x - fma(b.half.x, c, b.half.y * s),
          abs(in_a.y) - a.half.y - fma(b.half.x, s, b.half.y * c),
          abs(in_b.x) - b.half.x - fma(a.half.x, c, a.half.y * s),
          abs(in_b.y) - b.half.y - fma(a.half.x, s, a.half.y * c)};
}

MW_INLINE Corners<4> load_corners(const RectanglePose& r) {
  const Vec2 ux{r.q.c, r.q.s}, uy{-r.q.s, r.q.c};
  const Vec2 x = ux * r.half.x, y = uy * r.half.y;
  return {{-x - y, x - y, x + y, y - x}, {-uy, ux, uy, -ux}};
}
MW_INLINE Float radius_of(const RectanglePose&) { return Real(0); }

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
