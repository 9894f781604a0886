// One lane's shapes, sorted along the axis on which they are spread most and cut into strips across
// the next: whose bounds overlap meet once. Intervals are floats, in float64 too, and a little
// wider than the bounds; pairs that meet are tested again. The result depends on neither axes nor
// strips.
#pragma once

#include "kernels/broad/radix_sort.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

class LaneSweep {
 public:
  LaneSweep(const Constants& t, Work& w, int lane)
      : t_(t),
        w_(w),
        s_(w.sparse),
        lane_(lane),
        dim_(t.dimension == kernels::Dimension::spatial ? 3 : 2) {}

  // Takes the bounds of the shapes that are there, fixed ones but planes included.
  void prepare(const Group& g) { sort(take_bounds(g)); }

  // meet(shape, shape) for each pair: colliders, then fixed shapes. May be called again.
  template <class Meet>
  MW_INLINE void run(Meet meet) {
    for (int s = 0; s < strips_; ++s) {
      const int first = s_.strip_start[s], end = s_.strip_start[s + 1];
      dim_ == 3 ? sweep<3>(s, first, end, meet) : sweep<2>(s, first, end, meet);
    }
  }

 private:
  // What an interval grows by, so that rounding to float cannot lose a pair.
  static constexpr float kSlack = 1e-6f;
  static MW_INLINE Real magnitude(Real x) { return x < 0 ? -x : x; }

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
  int take_bounds(const Group& g) {
    const bool idle = has_idle_bodies(g);
    int count = 0;
    for (int i = 0; i < t_.colliders; ++i) {
      if (idle && ((g.absent[t_.collider_body[i]] >> lane_) & 1u) != 0) continue;
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
    strips_ = !(wanted > 1) ? 1 : wanted < kMaxStrips ? static_cast<int>(wanted) : kMaxStrips;
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

  template <int kDim, class Meet>
  MW_INLINE void sweep(int strip, int first, int end, Meet meet) {
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

  const Constants& t_;
  Work& w_;
  SparseWork& s_;
  int lane_, dim_, strips_ = 1;
  float strips_per_length_ = 0;
  Spread spread_[3];
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
