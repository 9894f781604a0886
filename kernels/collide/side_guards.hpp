// Guards (manifold.hpp) at the ends of the stretch along which two sides lie beside each other.
//
// Two cylinders or capsules whose axes are within some 60 degrees touch at one point. Pushed there
// they turn, and before the next step one may come down with its other end, by as much as it turns.
// A row for that end, apart or not, stops it where it lands.
#pragma once

#include "kernels/collide/manifold.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kBeside2 = Real(0.8);   // square of the sine between such axes
inline constexpr Real kFarAlong = Real(0.2);  // of the stretch: from the nearest place to an end
// Of a cylinder's axis along the normal, at most, where its side is what touches.
inline constexpr Real kSideOn = Real(0.8);

// The side of a shape that has an axis, as a line.
struct SideLine {
  Vec3 axis;
  Float half, radius;
  Vec3 out;  // from the axis to the surface
};

// `nearest`: the place on A's axis of the manifold's first point; d: from A to B. Writes points 1
// and 2 in lanes of `use`.
template <class S>
MW_INLINE void put_side_guards(const SideLine& a, const SideLine& b, Vec3 d, Float nearest,
                               Mask use, Manifold<S, 4>& m) {
  const Float zero(Real(0)), half(Real(0.5));
  const Float cosine = dot(a.axis, b.axis), da = dot(a.axis, d), db = dot(b.axis, d);
  const Float low = max(-a.half, da - b.half), high = min(a.half, da + b.half);
  const Mask beside = use & (Float(Real(1) - kBeside2) < cosine * cosine) & (low < high);
  if (!any(beside)) return;
  const Float radii = a.radius + b.radius, share = a.radius / radii, one(Real(1));
  const Float far = (high - low) * Float(kFarAlong);
  for (int i = 1; i <= 2; ++i) {
    const Float place = i == 1 ? low : high;
    const Vec3 on_a = fma(a.axis, place, a.out);
    const Float opposite = clamp(fms(cosine, place, db), -b.half, b.half);
    const Vec3 on_b = fma(b.axis, opposite, d) + b.out;
    const Vec3 between = on_b - on_a;
    const Float along = dot(m.normal, between);
    // Aside of one another both fall away, down to where they pass. Anchors are on one line along
    // the normal.
    const Vec3 aside = fnma(m.normal, along, between);
    const Float sine2 = dot(aside, aside) / square(radii);
    const Float gap = fma(radii, one - sqrt(max(one - sine2, zero)), along);
    const Mask there = beside & (far < abs(place - nearest)) & (sine2 < one);
    const Vec3 base = fma(aside, share, on_a);
    const Vec3 point = fma(m.normal, along * half, base);
    m.point_a[i] = select(there, point, m.point_a[i]);
    m.point_b[i] = select(there, point - d, m.point_b[i]);
    m.separation[i] = select(there, gap, m.separation[i]);
    m.feature_x[i] = select(there, place, m.feature_x[i]);
    m.valid[i] = m.valid[i] | there;
    m.guard[i] = there;
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
