// drop_distant: what the bounds of rectangles take for near and is not.
//
// A rectangle at an angle fills half of its bounds, and much of what those take for near in a pile
// stays apart in the step. In dense blocks such a lane idles as others do; in rows it takes a place
// that another pair could have. So in rows the distance itself is asked before candidates are
// packed.
//
// Both layouts have the same rows, since no pair is dropped that could have one
// (rows/approach.hpp): a point has a row if its separation is less than the margin and what both
// sides approach each other by in the step, at most their travel. Poses are up to half a step
// ahead, which is at most half of the travel again.
#include "kernels/shape/rectangle.hpp"
#include "kernels/work/constants.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

MW_INLINE Vec2 centre_of(const Work& w, int shape) {
  return load_vec2(w.bounds + shape * 4 * kLanes);
}
MW_INLINE RectanglePose rectangle(const Work& w, const Group& g, int shape) {
  const auto& half = constants_of_shape(g, shape).half;
  return {centre_of(w, shape), load_rot2(w.facing + shape * 2 * kLanes), {half[0], half[1]}};
}

// Shapes that are farther apart have no row, m. Rounding loses a few units in the last place of the
// way between their centres.
MW_INLINE Float reach_of(const Constants& t, const Work& w, int a, int b) {
  const Vec2 apart = centre_of(w, b) - centre_of(w, a);
  const Float slack = (abs(apart.x) + abs(apart.y)) * Float(Real(1e-5));
  const Float travel = Float::load(w.travel + a * kLanes) + Float::load(w.travel + b * kLanes);
  return fma(travel, Float(Real(1.5)), Float(t.margin)) + slack;
}

MW_INLINE Mask may_touch_circle(const Constants& t, const Group& g, const Work& w, int a, int b) {
  const Float reach = reach_of(t, w, a, b) + Float(constants_of_shape(g, b).radius);
  return distance2_from(rectangle(w, g, a), centre_of(w, b)) < reach * reach;
}
MW_INLINE Mask may_touch_rectangle(const Constants& t, const Group& g, const Work& w, int a,
                                   int b) {
  const auto [ax, ay, bx, by] = separations(rectangle(w, g, a), rectangle(w, g, b));
  return max(max(ax, ay), max(bx, by)) < reach_of(t, w, a, b);
}

template <class MayTouch>
MW_INLINE void keep_near(Work& w, const kernels::PairClass<Real>& c, int at, MayTouch may_touch) {
  std::int32_t* hits = w.hits + c.first_key;
  std::uint32_t* masks = w.hit_masks + c.first_key;
  int n = 0;
  for (int i = 0; i < w.hit_count[at]; ++i) {
    const int pair = hits[i];
    const std::uint32_t m = masks[i] & bits(may_touch(c.a[pair], c.b[pair]));
    hits[n] = pair;
    masks[n] = m;
    n += m != 0;
  }
  w.hit_count[at] = n;
}

}  // namespace

void drop_distant(const Constants& t, const Group& g, Work& w) {
  // What pulls bodies together within the step is not in their travel.
  if (!w.travel || g.force) return;
  for (int i = 0; i < t.classes; ++i) {
    const auto& c = t.pair_class[i];
    if (!is_rectangle_pair(c)) continue;
    if (shape_b(c.kind) == kernels::ShapeKind::circle) {
      keep_near(w, c, i, [&](int a, int b) { return may_touch_circle(t, g, w, a, b); });
    } else {
      keep_near(w, c, i, [&](int a, int b) { return may_touch_rectangle(t, g, w, a, b); });
    }
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
