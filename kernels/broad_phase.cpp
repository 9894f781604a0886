// Broad phase: which candidate pairs of a class come close, as one bit per lane.
//
// Masked all-pairs tests every candidate of the plan in every lane. Sort and sweep orders each
// lane's shapes along x by a sorting network and tests only those that overlap there; what it
// finds passes the same test, so both give the same masks.
#include "kernels/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

using kernels::PairKind;

MW_INLINE Mask bounds_overlap(const Tables& t, const Work& w, int a, int b) {
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
MW_INLINE Mask round_overlap(const Tables& t, const Work& w, int a, int b) {
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

MW_INLINE Mask fixed_overlap(const Tables& t, const Work& w, int fixed, int b) {
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

MW_INLINE bool is_round(PairKind kind) {
  return kind == PairKind::sphere_sphere || kind == PairKind::circle_circle;
}

// Tests `count` candidates of a class; `index(k)` names the k-th, `allowed(k)` its lanes.
template <class Overlap, class Allowed>
MW_INLINE void test_class(Work& w, const kernels::PairClass<Real>& c, int at, int count,
                          Overlap overlap, Allowed allowed) {
  std::int32_t* hits = w.hits + c.first_key;
  std::uint32_t* masks = w.hit_masks + c.first_key;
  int n = 0;
  for (int i = 0; i < count; ++i) {
    const std::uint32_t lanes = allowed(i);
    if (lanes == 0) continue;
    const std::uint32_t m = bits(overlap(c.a[i], c.b[i])) & lanes;
    hits[n] = i;
    masks[n] = m;
    n += m != 0;
  }
  w.hit_count[at] = n;
}

struct AllLanesAllowed {
  std::uint32_t operator()(int) const { return kAllLanes; }
};

template <class Allowed>
void test_pairs(const Tables& t, Work& w, int at, Allowed allowed) {
  const auto& c = t.pair_class[at];
  if (is_fixed(c.list)) {
    test_class(
        w, c, at, c.count, [&](int a, int b) { return fixed_overlap(t, w, a, b); }, allowed);
  } else if (is_round(c.kind)) {
    test_class(
        w, c, at, c.count, [&](int a, int b) { return round_overlap(t, w, a, b); }, allowed);
  } else {
    test_class(
        w, c, at, c.count, [&](int a, int b) { return bounds_overlap(t, w, a, b); }, allowed);
  }
}

}  // namespace

void broad_phase(const Tables& t, const Group&, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  if (t.sweep) sort_and_sweep(t, w);
  for (int i = 0; i < t.classes; ++i) {
    const auto& c = t.pair_class[i];
    if (t.sweep && !is_fixed(c.list)) {
      const std::uint32_t* marks = w.marks + c.first_key;
      test_pairs(t, w, i, [marks](int k) { return marks[k]; });
    } else {
      test_pairs(t, w, i, AllLanesAllowed{});
    }
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
