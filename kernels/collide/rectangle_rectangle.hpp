// Rectangle against rectangle: four axes, then edge against edge. In overlap A's faces win near
// ties by face_tie.
#pragma once

#include "kernels/collide/segments.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct RectangleRectangle {
  using A = RectanglePose;
  using B = RectanglePose;
  static constexpr int kPoints = 2;
  static MW_INLINE void collide(const Constants& t, const A& a, const B& b, Float,
                                Manifold<S, 2>& m) {
    const Float zero(Real(0)), one(Real(1)), tie(Real(1e-3));
    const Vec2 d = b.p - a.p;
    const auto [ax, ay, bx, by] = separations(a, b);
    const Mask a_uses_y = ax < ay, b_uses_y = bx < by;
    const Float best_a = max(ax, ay), best_b = max(bx, by);
    const Mask from_b = (best_a + Float(t.face_tie) < best_b) | (max(best_a, zero) < best_b);

    const Rot2 ref_q = select(from_b, b.q, a.q), inc_q = select(from_b, a.q, b.q);
    const Vec2 ref_half = select(from_b, b.half, a.half), inc_half = select(from_b, a.half, b.half);
    const Vec2 d_r = select(from_b, -d, d);
    const Mask uses_y = (from_b & b_uses_y) | (!from_b & a_uses_y);
    const Vec2 ref_x{ref_q.c, ref_q.s}, ref_y{-ref_q.s, ref_q.c};
    Vec2 normal = select(uses_y, ref_y, ref_x);
    const Float side = copysign(one, dot(normal, d_r));
    normal = normal * side;

    // Incident edge: the one whose normal is most opposed; near ties go to x.
    const Vec2 local = rotate_inverse(inc_q, normal);
    const Mask inc_y = abs(local.x) + tie < abs(local.y);
    const Float inc_side = copysign(one, -select(inc_y, local.y, local.x));
    const Vec2 inc_x_axis{inc_q.c, inc_q.s}, inc_y_axis{-inc_q.s, inc_q.c};
    const Vec2 inc_n = select(inc_y, inc_y_axis, inc_x_axis) * inc_side;
    const Vec2 inc_t{-inc_n.y, inc_n.x};

    EdgePair e;
    e.normal = normal;
    e.middle = normal * select(uses_y, ref_half.y, ref_half.x);
    e.half = select(uses_y, ref_half.x, ref_half.y);
    e.incident_middle = fma(inc_n, select(inc_y, inc_half.y, inc_half.x), d_r);
    e.incident_half = inc_t * select(inc_y, inc_half.x, inc_half.y);
    e.flip = from_b;
    e.d = d;
    clip_edges(e, Float(t.margin), m);
    const Float two(Real(2)), four(Real(4));
    const Float ref_edge = select(uses_y, one, zero) + select(zero < side, two, zero);
    const Float inc_edge = select(inc_y, one, zero) + select(zero < inc_side, two, zero);
    m.code = select(from_b, fma(ref_edge, four, inc_edge), fma(inc_edge, four, ref_edge));
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
