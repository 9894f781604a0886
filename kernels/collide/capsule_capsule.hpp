// Capsule against capsule in space: one point, between the nearest places of the two axes, or two
// where the axes are parallel within kParallel2 and lie side by side: at the ends of the stretch
// that they share. Where they are less parallel those may be guarded (side_guards.hpp). Points are
// told apart by their place along A's axis.
#pragma once

#include "kernels/collide/capsule_pairs.hpp"
#include "kernels/collide/side_guards.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Square of the sine of the angle below which two axes count as parallel.
inline constexpr Real kParallel2 = Real(4e-4);
// Of trees, whose contacts are MuJoCo's: what float32 makes of axes that are parallel.
inline constexpr Real kParallelOfTrees2 = Real(1e-11);

template <class S>
struct CapsuleCapsule {
  using A = CapsulePose<Vec3>;
  using B = CapsulePose<Vec3>;
  static constexpr int kPoints = 4;
  static MW_INLINE void collide(const Constants& table, const A& a, const B& b, Float,
                                Manifold<S, 4>& m) {
    const Float zero(Real(0)), one(Real(1));
    const Float parallel2(table.tree.links > 0 ? kParallelOfTrees2 : kParallel2);
    const Vec3 d = b.p - a.p;
    const Float cosine = dot(a.axis, b.axis), da = dot(a.axis, d), db = dot(b.axis, d);
    const Vec3 product = cross(a.axis, b.axis);
    const Float sine2 = dot(product, product);

    // Nearest places s on A's axis and t on B's: on the lines first, then each clamped to its own
    // axis for the other. Of parallel lines any s will do.
    Float s = clamp(fnma(cosine, db, da) / max(sine2, Real(1e-12)), -a.half, a.half);
    const Float t = clamp(fms(cosine, s, db), -b.half, b.half);
    s = clamp(fma(cosine, t, da), -a.half, a.half);
    const Vec3 gap = fma(b.axis, t, d) - a.axis * s;
    const Float gap2 = dot(gap, gap);
    const Mask apart = Float(kTinyDistance2) < gap2;
    // Axes that cross part along their common perpendicular.
    const Mask crossed = Float(Real(1e-12)) < sine2;
    const Vec3 perpendicular = select(crossed, product, across(a.axis));
    const Vec3 fallback =
        perpendicular * (copysign(one, dot(perpendicular, d)) /
                         sqrt(max(dot(perpendicular, perpendicular), Real(1e-12))));
    m.normal = select(apart, gap * (one / sqrt(select(apart, gap2, one))), fallback);
    m.tangent = tangent_along(a.axis, m.normal);

    const Float low = max(-a.half, da - b.half), high = min(a.half, da + b.half);
    const Mask beside = (sine2 < parallel2) & (low < high);
    const Float place[2] = {select(beside, low, s), select(beside, high, s)};
    for (int i = 0; i < 2; ++i) {
      const Vec3 base = a.axis * place[i];
      const Float opposite = select(beside, clamp(fms(cosine, place[i], db), -b.half, b.half), t);
      const Vec3 across_gap = fma(b.axis, opposite, d) - base;
      put_point(m, i, base, a.radius, dot(m.normal, across_gap) - a.radius - b.radius, d);
      m.feature_x[i] = place[i];
      m.feature_y[i] = zero;
    }
    m.valid[0] = mask_from_bits(kAllLanes);
    leave_out_points(m, 2);
    m.valid[1] = beside;
    if (table.tree.links == 0) {
      const SideLine side_a{a.axis, a.half, a.radius, m.normal * a.radius};
      const SideLine side_b{b.axis, b.half, b.radius, m.normal * -b.radius};
      put_side_guards(side_a, side_b, d, s, !beside, m);
    }
    m.code = select(beside, one, zero);
    // A single point may wander along the axis as the bodies roll over each other.
    const Float extent = min(a.half, b.half);
    m.match_distance2 = select(beside, match_distance2(extent), square(a.half + a.half));
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
