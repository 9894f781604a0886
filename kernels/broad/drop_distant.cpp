// drop_distant: what the bounds of rectangles take for near and is not.
//
// A rectangle at an angle fills half of its bounds: of the pairs of rectangles that bounds take for
// near in a pile, a third stay apart in the step (bin2d). In dense blocks such a lane idles as
// others do; in rows it takes a place that another pair could have. So in rows the distance itself
// is asked before candidates are packed.
//
// Both layouts have the same rows, since no pair is dropped that could have one
// (rows/approach.hpp): a point has a row if its separation is less than the margin and what both
// sides approach each other by in the step, at most their travel. Poses are up to half a step
// ahead, which is at most half of the travel again.
#include "kernels/work/constants.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// Of a rectangle or circle, in all lanes.
struct Outline {
  Vec2 centre;
  Rot2 facing;
  Vec2 half;
  Float radius, travel;

  MW_INLINE Outline(const Work& w, const Group& g, int shape)
      : centre(load_vec2(w.bounds + shape * 4 * kLanes)),
        facing(load_rot2(w.facing + shape * 2 * kLanes)),
        half{constants_of_shape(g, shape).half[0], constants_of_shape(g, shape).half[1]},
        radius(constants_of_shape(g, shape).radius),
        travel(Float::load(w.travel + shape * kLanes)) {}
};

// Shapes that are farther apart have no row, m. Rounding loses a few units in the last place of
// `apart`, the way between their centres.
MW_INLINE Float reach_of(const Constants& t, const Outline& a, const Outline& b, Vec2 apart) {
  const Float slack = (abs(apart.x) + abs(apart.y)) * Float(Real(1e-5));
  return fma(a.travel + b.travel, Float(Real(1.5)), Float(t.margin)) + slack;
}

MW_INLINE Mask may_touch_circle(const Constants& t, const Outline& a, const Outline& b) {
  const Float zero(Real(0));
  const Vec2 d = b.centre - a.centre, local = rotate_inverse(a.facing, d);
  const Vec2 out{max(abs(local.x) - a.half.x, zero), max(abs(local.y) - a.half.y, zero)};
  const Float reach = reach_of(t, a, b, d) + b.radius;
  return dot(out, out) < reach * reach;
}

MW_INLINE Mask may_touch_rectangle(const Constants& t, const Outline& a, const Outline& b) {
  const Vec2 d = b.centre - a.centre;
  const Vec2 in_a = rotate_inverse(a.facing, d), in_b = rotate_inverse(b.facing, d);
  const Float c = abs(fma(a.facing.c, b.facing.c, a.facing.s * b.facing.s));
  const Float s = abs(fms(a.facing.c, b.facing.s, a.facing.s * b.facing.c));
  const Float ax = abs(in_a.x) - a.half.x - fma(b.half.x, c, b.half.y * s);
  const Float ay = abs(in_a.y) - a.half.y - fma(b.half.x, s, b.half.y * c);
  const Float bx = abs(in_b.x) - b.half.x - fma(a.half.x, c, a.half.y * s);
  const Float by = abs(in_b.y) - b.half.y - fma(a.half.x, s, a.half.y * c);
  return max(max(ax, ay), max(bx, by)) < reach_of(t, a, b, d);
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
  // What pulls bodies together within the step is not in their travel, but gravity pulls all alike.
  const bool coast =
      t.uniform_gravity && !t.delta_v_varies && !t.first_thrust && !g.force && t.attractors == 0;
  if (!w.travel || !coast) return;
  for (int i = 0; i < t.classes; ++i) {
    const auto& c = t.pair_class[i];
    if (!is_rectangle_pair(c)) continue;
    if (shape_b(c.kind) == kernels::ShapeKind::circle) {
      keep_near(w, c, i, [&](int a, int b) {
        return may_touch_circle(t, Outline(w, g, a), Outline(w, g, b));
      });
    } else {
      keep_near(w, c, i, [&](int a, int b) {
        return may_touch_rectangle(t, Outline(w, g, a), Outline(w, g, b));
      });
    }
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
