// The broad phase of plans without tables of pairs: memory and time follow the number of shapes
// and of pairs that come close, not of all pairs.
//
// One lane at a time: its shapes, fixed ones included, are sorted along the axis on which they are
// spread most and cut into strips across the next; in its strips each meets those that begin before
// its end. What passes the same tests as in
// plans with tables gets its key (kernels/pair_keys.hpp); sorted by key, the pairs of all lanes are
// merged into hits with a mask of lanes, and from there on nothing differs. Neither axes nor
// strips can be told from the result.
#include "kernels/overlap.hpp"
#include "kernels/pair_keys.hpp"
#include "kernels/radix_sort.hpp"
#include "kernels/sleep.hpp"
#include "kernels/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// What an interval grows by, so that rounding to float cannot lose a pair.
constexpr float kSlack = 1e-6f;

Real magnitude(Real x) { return x < 0 ? -x : x; }

class LaneSearch {
 public:
  LaneSearch(const Tables& t, const Group& g, Work& w, int lane, bool wakes)
      : t_(t),
        g_(g),
        w_(w),
        s_(w.sparse),
        lane_(lane),
        dim_(t.dimension == kernels::Dimension::spatial ? 3 : 2),
        wakes_(wakes),
        idle_(has_idle_bodies(g)) {}

  void run() {
    const int count = take_bounds();
    sort(count);
    do {  // who is woken may lie close to another island
      woke_ = false;
      found_ = 0;
      sweep_strips();
    } while (woke_);
    limit();
    for (int i = 0; i < found_; ++i) s_.pairs[lane_ * s_.lane_room + i] = s_.found[i];
    s_.count[lane_] = found_;
  }

 private:
  bool is(std::uint32_t lanes) const { return ((lanes >> lane_) & 1u) != 0; }
  float* low(float* of, int axis, int copies = 1) const {
    return of + axis * 2 * copies * s_.shapes;
  }
  float* high(float* of, int axis, int copies = 1) const {
    return of + (axis * 2 + 1) * copies * s_.shapes;
  }

  // `size`: of the numbers that the interval was made of.
  void put(int place, int axis, Real from, Real to, Real size) {
    const float slack = kSlack * static_cast<float>(size);
    low(s_.bounds, axis)[place] = static_cast<float>(from) - slack;
    high(s_.bounds, axis)[place] = static_cast<float>(to) + slack;
  }

  // Intervals of the lane's shapes that are there; returns how many.
  int take_bounds() {
    int count = 0;
    for (int i = 0; i < t_.colliders; ++i) {
      if (idle_ && is(g_.absent[t_.collider_body[i]])) continue;
      const Real* p = w_.bounds + i * 2 * dim_ * kLanes + lane_;
      for (int c = 0; c < dim_; ++c) {
        const Real centre = p[c * kLanes], half = p[(dim_ + c) * kLanes];
        put(count, c, centre - half, centre + half, magnitude(centre) + half);
      }
      s_.name[count++] = i;
    }
    for (int f = 0; f < t_.fixed_shapes; ++f) {
      const auto& shape = t_.fixed[f];
      if (shape.kind == kernels::ShapeKind::plane) continue;
      for (int c = 0; c < dim_; ++c) {
        put(count, c, shape.low[c] - t_.half_margin, shape.high[c] + t_.half_margin,
            magnitude(shape.low[c]) + magnitude(shape.high[c]) + t_.half_margin);
      }
      s_.name[count++] = t_.colliders + f;
    }
    return count;
  }

  // How far the shapes are spread along an axis, in their own lengths.
  struct Spread {
    int axis = 0;
    float score = -1, from = 0, range = 0, length = 0;
  };
  Spread spread_along(int axis, int count) const {
    float sum = 0, squares = 0, length = 0, least = 0, most = 0;
    const float *from = low(s_.bounds, axis), *to = high(s_.bounds, axis);
    for (int i = 0; i < count; ++i) {
      const float a = from[i] - from[0];
      sum += a;
      squares += a * a;
      length += to[i] - from[i];
      least = a < least ? a : least;
      most = a > most ? a : most;
    }
    const auto n = static_cast<float>(count);
    const float score = (squares * n - sum * sum) / (length * length);
    return {axis, score, count > 0 ? from[0] + least : 0, most - least, length / n};
  }

  // Axes from the one with the widest spread on; the sweep goes along the first.
  void order_axes(int count) {
    for (int c = 0; c < dim_; ++c) {
      Spread spread = spread_along(c, count);
      int at = c;
      for (; at > 0 && spread_[at - 1].score < spread.score; --at) spread_[at] = spread_[at - 1];
      spread_[at] = spread;
    }
  }

  // Sorts along the first axis and cuts into strips across the second: a shape meets only what is
  // in its own strips.
  void sort(int count) {
    order_axes(count);
    const float* begin = low(s_.bounds, spread_[0].axis);
    for (int i = 0; i < count; ++i) {
      s_.order[i] = word_of(ordered_bits(begin[i]), static_cast<std::uint32_t>(i));
    }
    const std::uint64_t* sorted = radix_sort(s_.order, s_.order_spare, count);
    cut(count);
    for (int i = 0; i < count; ++i) {
      const auto from = low_of(sorted[i]);
      const int last = strip_of(high(s_.bounds, spread_[1].axis)[from]);
      const int first = strip_of(low(s_.bounds, spread_[1].axis)[from]);
      for (int strip = first; strip <= last; ++strip) {
        const int place = s_.strip_start[strip + 1]++;  // becomes its end
        s_.shape[place] = s_.name[from];
        s_.first_strip[place] = first;
        for (int k = 0; k < dim_; ++k) {
          low(s_.sorted, k, kCopies)[place] = low(s_.bounds, spread_[k].axis)[from];
          high(s_.sorted, k, kCopies)[place] = high(s_.bounds, spread_[k].axis)[from];
        }
      }
    }
  }

  int strip_of(float x) const {
    const float at = (x - spread_[1].from) * strips_per_length_;
    const auto most = static_cast<float>(strips_ - 1);
    return !(at > 0) ? 0 : at < most ? static_cast<int>(at) : strips_ - 1;
  }

  // As many strips as are twice the length of a shape wide, or fewer where large shapes would lie
  // in too many of them; counts what they hold.
  void cut(int count) {
    const float wanted = spread_[1].range / (2 * spread_[1].length);
    strips_ = !(wanted > 1) ? 1 : wanted < kMostStrips ? static_cast<int>(wanted) : kMostStrips;
    for (;; strips_ /= 2) {
      strips_per_length_ = static_cast<float>(strips_) / spread_[1].range;
      for (int s = 0; s <= strips_ + 1; ++s) s_.strip_start[s] = 0;
      int copies = 0;
      for (int i = 0; i < count; ++i) {
        const int last = strip_of(high(s_.bounds, spread_[1].axis)[i]);
        const int first = strip_of(low(s_.bounds, spread_[1].axis)[i]);
        copies += last - first + 1;
        for (int s = first; s <= last && copies <= kCopies * count; ++s) ++s_.strip_start[s + 2];
      }
      if (strips_ == 1 || copies <= kCopies * count) break;
    }
    for (int s = 0; s <= strips_; ++s) s_.strip_start[s + 1] += s_.strip_start[s];
  }

  void sweep_strips() {
    for (int s = 0; s < strips_; ++s) {
      dim_ == 3 ? sweep<3>(s, s_.strip_start[s], s_.strip_start[s + 1])
                : sweep<2>(s, s_.strip_start[s], s_.strip_start[s + 1]);
    }
  }

  template <int kDim>
  void sweep(int strip, int first, int end) {
    const float *low0 = low(s_.sorted, 0, kCopies), *high0 = high(s_.sorted, 0, kCopies);
    const float *low1 = low(s_.sorted, 1, kCopies), *high1 = high(s_.sorted, 1, kCopies);
    const float* low2 = kDim == 3 ? low(s_.sorted, 2, kCopies) : low1;
    const float* high2 = kDim == 3 ? high(s_.sorted, 2, kCopies) : high1;
    for (int i = first; i < end; ++i) {
      const float end0 = high0[i], begin1 = low1[i], end1 = high1[i];
      const float begin2 = low2[i], end2 = high2[i];
      for (int j = i + 1; j < end && low0[j] < end0; ++j) {
        const bool beside = !(low1[j] < end1) | !(begin1 < high1[j]);
        const bool above = kDim == 3 && (!(low2[j] < end2) | !(begin2 < high2[j]));
        if (beside | above) continue;
        // In several strips they meet in the first that they share.
        const int a = s_.first_strip[i], b = s_.first_strip[j];
        if ((a < b ? b : a) == strip) meet(s_.shape[i], s_.shape[j]);
      }
    }
  }

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
      if (t_.body[sleeper].inv_mass > Real(0)) {
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

  const Tables& t_;
  const Group& g_;
  Work& w_;
  SparseWork& s_;
  int lane_, dim_, found_ = 0, strips_ = 1;
  float strips_per_length_ = 0;
  Spread spread_[3];
  bool wakes_, idle_, woke_ = false;
};

// Planes are close to all shapes or to none along them: each is tested against all, in all lanes.
void meet_planes(const Tables& t, const Group& g, Work& w, int at) {
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
void merge_lanes(const Tables& t, Work& w, std::uint32_t lanes) {
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

void find_sparse_pairs(const Tables& t, const Group& g, Work& w) {
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
