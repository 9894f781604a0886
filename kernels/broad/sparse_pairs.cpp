// The broad phase of plans without tables of pairs: memory and time follow the number of shapes
// and of pairs that come close, not of all pairs.
//
// One lane at a time: its shapes are swept (kernels/broad/lane_sweep.hpp). What passes the same
// tests as in plans with tables gets its key (kernels/data/pair_keys.hpp); sorted by key, the pairs
// of all lanes are merged into hits with a mask of lanes, and from there on nothing differs.
#include "kernels/broad/lane_sweep.hpp"
#include "kernels/data/pair_keys.hpp"
#include "kernels/shape/overlap.hpp"
#include "kernels/sleep/sleep.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

class LaneSearch {
 public:
  LaneSearch(const Constants& t, const Group& g, Work& w, int lane, bool wakes)
      : t_(t), g_(g), w_(w), s_(w.sparse), lane_(lane), wakes_(wakes), idle_(has_idle_bodies(g)) {}

  void run() {
    LaneSweep sweep(t_, w_, lane_);
    sweep.prepare(g_);
    do {  // a body that wakes may lie close to another island
      woke_ = false;
      found_ = 0;
      sweep.run([this](int a, int b) { meet(a, b); });
    } while (woke_);
    limit();
    for (int i = 0; i < found_; ++i) s_.pairs[lane_ * s_.lane_room + i] = s_.found[i];
    s_.count[lane_] = found_;
  }

 private:
  bool is(std::uint32_t lanes) const { return ((lanes >> lane_) & 1u) != 0; }

  void meet(int a, int b) {
    const int i = a < b ? a : b, j = a < b ? b : a;
    if (j < t_.colliders) {
      meet_moving(i, j);
    } else if (i < t_.colliders) {
      meet_fixed(j - t_.colliders, i);
    }
  }

  void meet_moving(int i, int j) {
    const kernels::ClassOfPair c = kernels::class_of_moving(t_, i, j);
    if (c.index < 0 || !kernels::may_touch(t_, i, j)) return;
    const int a = t_.collider_body[i], b = t_.collider_body[j];
    if (idle_ && is(g_.asleep[a] & g_.asleep[b])) return;
    const auto& pairs = t_.pair_class[c.index];
    if (!is(bits(is_round(pairs.kind) ? round_overlap(t_, w_, i, j)
                                      : bounds_overlap(t_, w_, i, j)))) {
      return;
    }
    if (wakes_ && is(g_.asleep[a] ^ g_.asleep[b])) {
      const int sleeper = is(g_.asleep[a]) ? a : b;
      if (!t_.body[sleeper].kinematic) {
        wake_island(t_, g_, sleeper, lane_);
        woke_ = true;
      }
    }
    add(pairs.first_key + kernels::tournament_place(t_.colliders, i, j), c.swapped ? j : i,
        c.swapped ? i : j);
  }

  void meet_fixed(int fixed, int j) {
    const std::int32_t c = kernels::class_of_fixed(t_, fixed, j);
    if (c < 0 || !kernels::may_touch_fixed(t_, fixed, j)) return;
    if (idle_ && is(idle_lanes(g_, t_.collider_body[j]))) return;
    if (!is(bits(fixed_overlap(t_, w_, fixed, j)))) return;
    add(t_.pair_class[c].first_key + fixed * t_.colliders + j, fixed, j);
  }

  void add(std::int32_t key, std::int32_t a, std::int32_t b) {
    if (woke_) return;  // all of it is found again
    if (found_ == s_.room) limit();
    s_.found[found_++] =
        word_of(static_cast<std::uint32_t>(key),
                static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b) << 16);
  }

  // Sorts what was found and drops the last candidates of classes that have too many: the same ones
  // as in plans with tables, since what is dropped early has enough before it.
  void limit() {
    std::uint64_t* sorted = radix_sort(s_.found, s_.found_spare, found_);
    if (sorted != s_.found) {
      s_.found_spare = s_.found;
      s_.found = sorted;
    }
    int kept = 0, of_class = 0;
    const kernels::PairClass<Real>* c = t_.pair_class;
    for (int i = 0; i < found_; ++i) {
      const auto key = static_cast<std::int32_t>(high_of(sorted[i]));
      for (; key - c->first_key >= c->count; ++c) of_class = 0;
      if (of_class == candidate_limit(t_, *c)) {
        w_.overflow |= 1u << lane_;
        continue;
      }
      ++of_class;
      sorted[kept++] = sorted[i];
    }
    found_ = kept;
  }

  const Constants& t_;
  const Group& g_;
  Work& w_;
  SparseWork& s_;
  int lane_, found_ = 0;
  bool wakes_, idle_, woke_ = false;
};

// Planes are close to all shapes or to none along them: each is tested against all, in all lanes.
void meet_planes(const Constants& t, const Group& g, Work& w, int at) {
  const auto& c = t.pair_class[at];
  const bool idle = has_idle_bodies(g);
  const int first = first_hit(t, w, at), limit = candidate_limit(t, c);
  int hits = 0, count[kLanes] = {};
  for (int f = 0; f < t.fixed_shapes; ++f) {
    if (t.fixed[f].kind != kernels::ShapeKind::plane) continue;
    for (int j = 0; j < t.colliders; ++j) {
      if (kernels::class_of_fixed(t, f, j) != at || !kernels::may_touch_fixed(t, f, j)) continue;
      std::uint32_t lanes = idle ? ~idle_lanes(g, t.collider_body[j]) : kAllLanes;
      lanes &= bits(fixed_overlap(t, w, f, j));
      for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
        const int lane = __builtin_ctz(m);
        if (count[lane]++ < limit) continue;
        lanes &= ~(1u << lane);
        w.overflow |= 1u << lane;
      }
      if (lanes == 0) continue;
      w.hits[first + hits] = f * t.colliders + j;
      w.sparse.hit_code[first + hits] = f | (j << 16);
      w.hit_masks[first + hits] = lanes;
      ++hits;
    }
  }
  w.hit_count[at] = hits;
}

// The pairs of the lanes, each ascending, into the hits of the classes.
void merge_lanes(const Constants& t, Work& w, std::uint32_t lanes) {
  SparseWork& s = w.sparse;
  const std::uint64_t *next[kLanes], *end[kLanes];
  for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
    const int l = __builtin_ctz(m);
    next[l] = s.pairs + l * s.lane_room;
    end[l] = next[l] + s.count[l];
    if (next[l] == end[l]) lanes &= ~(1u << l);
  }
  for (int c = 0; lanes != 0;) {
    std::uint64_t least = ~std::uint64_t{0};
    for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
      const std::uint64_t word = *next[__builtin_ctz(m)];
      least = word < least ? word : least;
    }
    std::uint32_t mask = 0;
    for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
      const int l = __builtin_ctz(m);
      if (*next[l] != least) continue;
      mask |= 1u << l;
      if (++next[l] == end[l]) lanes &= ~(1u << l);
    }
    const auto key = static_cast<std::int32_t>(high_of(least));
    while (key - t.pair_class[c].first_key >= t.pair_class[c].count) ++c;
    const int at = first_hit(t, w, c) + w.hit_count[c]++;
    w.hits[at] = key - t.pair_class[c].first_key;
    s.hit_code[at] = static_cast<std::int32_t>(low_of(least));
    w.hit_masks[at] = mask;
  }
}

}  // namespace

void find_sparse_pairs(const Constants& t, const Group& g, Work& w) {
  const bool idle = has_idle_bodies(g);
  std::uint32_t lanes = kAllLanes, mixed = 0;
  if (idle) {
    const LaneActivity activity = activity_of(t, g);
    lanes = activity.awake;
    if (t.has_sleep) mixed = activity.asleep & activity.awake & ~w.frozen;
  }
  if (!w.recorder) lanes &= ~w.frozen;  // nothing comes of it
  for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
    const int l = __builtin_ctz(m);
    LaneSearch(t, g, w, l, ((mixed >> l) & 1u) != 0).run();
  }
  if (t.has_sleep && idle) keep_sleeping_contacts(t, g, w);
  for (int c = 0; c < t.classes; ++c) {
    w.hit_count[c] = 0;
    if (is_plane(t.pair_class[c].kind)) meet_planes(t, g, w, c);
  }
  merge_lanes(t, w, lanes);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
