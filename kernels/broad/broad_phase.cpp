// Broad phase: which candidate pairs of a class come close, as one bit per lane.
//
// Masked all-pairs tests every candidate of the plan in every lane. Sort and sweep orders each
// lane's shapes along x by a sorting network and tests only those that overlap there; what it
// finds passes the same test, so both give the same masks. Sparse plans have a broad phase of their
// own (kernels/broad/sparse_pairs.cpp).
#include "kernels/shape/overlap.hpp"
#include "kernels/sleep/sleep.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

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
void test_pairs(const Constants& t, Work& w, int at, Allowed allowed) {
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

// The same, leaving out lanes in which neither body of a pair can act on the other.
template <class Allowed>
void test_live_pairs(const Constants& t, const Group& g, Work& w, int at, Allowed allowed) {
  if (!has_idle_bodies(g)) return test_pairs(t, w, at, allowed);
  const auto& c = t.pair_class[at];
  const std::int32_t* body = t.collider_body;
  if (is_fixed(c.list)) {
    test_pairs(t, w, at, [&](int k) { return allowed(k) & ~idle_lanes(g, body[c.b[k]]); });
  } else {
    test_pairs(t, w, at,
               [&](int k) { return allowed(k) & live_lanes(g, body[c.a[k]], body[c.b[k]]); });
  }
}

}  // namespace

void broad_phase(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  if (t.sparse) return find_sparse_pairs(t, g, w);
  if (t.sweep) sort_and_sweep(t, w);
  if (t.has_sleep && has_idle_bodies(g)) {
    wake_touched(t, g, w);
    keep_sleeping_contacts(t, g, w);
  }
  for (int i = 0; i < t.classes; ++i) {
    const auto& c = t.pair_class[i];
    if (t.sweep && !is_fixed(c.list)) {
      const std::uint32_t* marks = w.marks + c.first_key;
      test_live_pairs(t, g, w, i, [marks](int k) { return marks[k]; });
    } else {
      test_live_pairs(t, g, w, i, AllLanesAllowed{});
    }
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
