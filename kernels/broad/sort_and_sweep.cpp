// Sort and sweep, one world per lane: each lane's shapes in the order of their lower bounds along
// x, by a sorting network (Batcher's odd-even merge sort), which is the same sequence of
// compare-exchanges in every lane. Then every shape meets those after it until they begin beyond
// its end.
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

constexpr Real kSlack = sizeof(Real) == 4 ? Real(1e-6) : Real(1e-14);

// An entry of the sorted array: lower bound, upper bound, shape index as a number.
struct Entry {
  Float low, high, index;
};
MW_INLINE Entry load_entry(const Real* p) {
  return {Float::load(p), Float::load(p + kLanes), Float::load(p + 2 * kLanes)};
}
MW_INLINE void store_entry(Real* p, const Entry& e) {
  e.low.store(p), e.high.store(p + kLanes), e.index.store(p + 2 * kLanes);
}

MW_INLINE void compare_exchange(Real* sorted, int i, int j) {
  Real* p = sorted + i * 3 * kLanes;
  Real* q = sorted + j * 3 * kLanes;
  const Entry a = load_entry(p), b = load_entry(q);
  const Mask swap = b.low < a.low;
  if (!any(swap)) return;  // nearly sorted already: the usual case from step to step
  store_entry(p, {select(swap, b.low, a.low), select(swap, b.high, a.high),
                  select(swap, b.index, a.index)});
  store_entry(q, {select(swap, a.low, b.low), select(swap, a.high, b.high),
                  select(swap, a.index, b.index)});
}

void sort_lanes(Real* sorted, int n) {
  for (int p = 1; p < n; p *= 2) {
    for (int k = p; k >= 1; k /= 2) {
      for (int j = k % p; j + k < n; j += 2 * k) {
        for (int i = 0; i < k && i + j + k < n; ++i) {
          if ((i + j) / (2 * p) == (i + j + k) / (2 * p))
            compare_exchange(sorted, i + j, i + j + k);
        }
      }
    }
  }
}

}  // namespace

void sort_and_sweep(const Constants& t, Work& w) {
  const int n = t.colliders;
  const int dim = t.dimension == kernels::Dimension::spatial ? 3 : 2;
  for (int i = 0; i < n; ++i) {
    const Real* p = w.bounds + i * 2 * dim * kLanes;
    // A little wider than the test that decides, so that its rounding cannot lose a pair here.
    const Float centre = Float::load(p), extent = Float::load(p + dim * kLanes);
    const Float half = fma(abs(centre) + extent, kSlack, extent);
    store_entry(w.sorted + i * 3 * kLanes, {centre - half, centre + half, static_cast<Real>(i)});
  }
  sort_lanes(w.sorted, n);

  for (int c = 0; c < t.classes; ++c) {
    if (is_fixed(t.pair_class[c].list)) continue;
    for (int k = 0; k < t.pair_class[c].count; ++k) w.marks[t.pair_class[c].first_key + k] = 0;
  }
  for (int i = 0; i + 1 < n; ++i) {
    const Entry a = load_entry(w.sorted + i * 3 * kLanes);
    for (int j = i + 1; j < n; ++j) {
      const Real* q = w.sorted + j * 3 * kLanes;
      const std::uint32_t meets = bits(Float::load(q) < a.high);
      if (meets == 0) break;
      const Real* first = w.sorted + i * 3 * kLanes + 2 * kLanes;
      const Real* second = q + 2 * kLanes;
      for (int l = 0; l < kLanes; ++l) {
        if (!((meets >> l) & 1u)) continue;
        const int pair = t.pair_of[static_cast<int>(first[l]) * n + static_cast<int>(second[l])];
        if (pair >= 0) w.marks[pair] |= 1u << l;
      }
    }
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
