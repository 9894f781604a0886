// Balls that touch during the step: their normal of that moment.
//
// Rows keep one normal for a step, that of its start, and balls which are still apart then meet
// along another: at 2 m/s balls of 5 cm that hit two others come back up to 21 % too fast in steps
// of 1/60 s. With p from A's centre to B's, v their relative velocity and R the sum of the radii
// they touch when |p + v t| = R. So rows get n = (p + v t) / |p + v t|, along which the gap is
// n.p - R now: with t of the touch, or where there is none in this step, of its end or of the place
// where they pass, whichever is first. What stays on the far side of that plane stays out of the
// ball, and what does not touch is not stopped.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/rows/sides.hpp"
#include "kernels/shape/tangent.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Of the centre of a side's shape, m/s.
template <class S>
MW_INLINE typename S::Vec velocity_at(const Constants& t, const SideState<S, Free>& side,
                                      typename S::Vec pose) {
  if (t.collider_is_body) return side.velocity.v;
  return point_velocity(side.velocity, pose - side.body.centre);
}

// In the lanes of `active` in which the pair bounces, or hits as fast as in an impact. Points are
// from the shapes' centres still.
template <class S, class A>
MW_INLINE void turn_to_touch(const Constants& t, const Group& g, const Work& w,
                             const std::int32_t* code, const Sides<S, A>& sides, Mask active,
                             typename S::Vec pose_a, typename S::Vec pose_b,
                             Manifold<GeometryOf<S>, 1>& m) {
  const Float zero(Real(0)), one(Real(1));
  const Float radius_a = dot(m.normal, m.point_a[0]), radius_b = -dot(m.normal, m.point_b[0]);
  const Float gap = m.separation[0], reach = radius_a + radius_b;
  const typename S::Vec p = m.normal * (reach + gap);
  auto v = velocity_at(t, sides.b, pose_b);
  if constexpr (A::kMoves) v = v - velocity_at(t, sides.a, pose_a);
  const Float b = dot(p, v), v2 = dot(v, v);
  Mask turns = active & m.valid[0] & (zero < gap) & (b < zero);
  if (!any(turns)) return;
  const MaterialPair e = load_materials<A>(t, g, code, bits(active), &Material::restitution);
  Mask hits = zero < max(e.a, e.b);
  if (t.impact_sweeps > 0) hits = hits | (b < -(Float::load(w.strike_speed) * (reach + gap)));
  turns = turns & hits;
  // v^2 t^2 + 2 b t + c = 0, its earlier root; they pass at -b / v^2.
  const Float c = gap * (gap + (reach + reach)), rest = fms(b, b, v2 * c);
  const Mask touch = zero <= rest;
  const Float top = select(touch, c, -b), bottom = select(touch, sqrt(max(rest, zero)) - b, v2);
  const Float time = min(top / select(turns, bottom, one), Float(t.dt));
  const typename S::Vec q = fma(v, time, p);
  const Float length = sqrt(dot(q, q));
  const typename S::Vec n = select(turns, q * (one / length), m.normal);
  m.normal = n;
  m.separation[0] = select(turns, max(length - reach - dot(n, v) * time, zero), gap);
  m.point_a[0] = select(turns, n * radius_a, m.point_a[0]);
  m.point_b[0] = select(turns, n * -radius_b, m.point_b[0]);
  if constexpr (S::kDim == 3) m.tangent = select(turns, any_tangent(n), m.tangent);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
