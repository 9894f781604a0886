// Overlap tests of bounds, one pair of shapes in every lane. Broad phase and waking share them.
#pragma once

#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

MW_INLINE Mask bounds_overlap(const Constants& t, const Work& w, int a, int b) {
  if (t.dimension == kernels::Dimension::spatial) {
    const Real* pa = w.bounds + a * 6 * kLanes;
    const Real* pb = w.bounds + b * 6 * kLanes;
    const Vec3 d = load_vec3(pa) - load_vec3(pb);
    const Vec3 e = load_vec3(pa + 3 * kLanes) + load_vec3(pb + 3 * kLanes);
    return max(max(abs(d.x) - e.x, abs(d.y) - e.y), abs(d.z) - e.z) < Float(Real(0));
  }
  const Real* pa = w.bounds + a * 4 * kLanes;
  const Real* pb = w.bounds + b * 4 * kLanes;
  const Vec2 d = load_vec2(pa) - load_vec2(pb);
  const Vec2 e = load_vec2(pa + 2 * kLanes) + load_vec2(pb + 2 * kLanes);
  return max(abs(d.x) - e.x, abs(d.y) - e.y) < Float(Real(0));
}

// Spheres and circles: their bounds' half extent is radius plus margin, so this test is exact.
MW_INLINE Mask round_overlap(const Constants& t, const Work& w, int a, int b) {
  if (t.dimension == kernels::Dimension::spatial) {
    const Real* pa = w.bounds + a * 6 * kLanes;
    const Real* pb = w.bounds + b * 6 * kLanes;
    const Vec3 d = load_vec3(pa) - load_vec3(pb);
    const Float reach = Float::load(pa + 3 * kLanes) + Float::load(pb + 3 * kLanes);
    return dot(d, d) < reach * reach;
  }
  const Real* pa = w.bounds + a * 4 * kLanes;
  const Real* pb = w.bounds + b * 4 * kLanes;
  const Vec2 d = load_vec2(pa) - load_vec2(pb);
  const Float reach = Float::load(pa + 2 * kLanes) + Float::load(pb + 2 * kLanes);
  return dot(d, d) < reach * reach;
}

MW_INLINE Mask fixed_overlap(const Constants& t, const Work& w, int fixed, int b) {
  const auto& f = t.fixed[fixed];
  const bool spatial = t.dimension == kernels::Dimension::spatial;
  const int dim = spatial ? 3 : 2;
  const Real* p = w.bounds + b * 2 * dim * kLanes;
  if (f.kind == kernels::ShapeKind::plane) {
    // Lowest point of the bounds along the normal.
    Float height = Float(-f.plane[3]) - Float::load(w.beyond + b * kLanes);
    for (int c = 0; c < dim; ++c) {
      const Real n = f.plane[c];
      if (n == Real(0)) continue;
      const Float half = Float::load(p + (dim + c) * kLanes);
      height = fma(Float(n), Float::load(p + c * kLanes) - (n > 0 ? half : -half), height);
    }
    return height < Float(t.half_margin);
  }
  Mask m = mask_from_bits(kAllLanes);
  for (int c = 0; c < dim; ++c) {
    const Float x = Float::load(p + c * kLanes), half = Float::load(p + (dim + c) * kLanes);
    m = m & (x - half < Float(f.high[c] + t.half_margin)) &
        (Float(f.low[c] - t.half_margin) < x + half);
  }
  return m;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
