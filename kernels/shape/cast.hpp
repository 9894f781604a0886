// cast: a body that moves more than half its extent in a step is swept against the fixed shapes
// that are not planes, and on request against moving shapes, and stops where its core first touches
// one. Planes need no cast: contacts with a speculative margin hold at any speed against a half
// space.
//
// The core is a sphere inside the body about its centre of mass, smaller than the body, so that
// passing an edge closely is not an impact. The time of touch is found by conservative
// advancement: the core may always move by its distance to the shape. The rest of the step's
// motion is dropped; the velocity stays, and the next step's contact deals with it.
//
// A moving shape is taken to translate without rotation while the step lasts: its rotation matters
// little to a body that crosses its own size meanwhile.
#pragma once

#include "kernels/shape/shapes.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kCastRounds = 32;

MW_INLINE Mask within_bounds(const Constants& t, Vec2 x) {
  return (Float(t.bounds_low[0]) <= x.x) & (x.x <= Float(t.bounds_high[0])) &
         (Float(t.bounds_low[1]) <= x.y) & (x.y <= Float(t.bounds_high[1]));
}
MW_INLINE Mask within_bounds(const Constants& t, Vec3 x) {
  return within_bounds(t, Vec2{x.x, x.y}) & (Float(t.bounds_low[2]) <= x.z) &
         (x.z <= Float(t.bounds_high[2]));
}

// Does any shape of the body collide with this one, by their filters?
MW_INLINE bool may_collide(const Constants& t, int body, const kernels::ColliderTable& other) {
  for (int i = t.first_collider[body]; i < t.first_collider[body + 1]; ++i) {
    const auto& own = t.collider[i];
    if ((own.category & other.mask) != 0 && (other.category & own.mask) != 0) return true;
  }
  return false;
}

// The share of `step` that the core may go from `start` before it touches the shape; 1 when it
// does not, and where it begins inside: that is the contact's business.
template <class Vec, class Pose>
MW_INLINE Float free_share(const Pose& pose, Vec start, Vec step, Float core, Mask fast) {
  const Float zero(Real(0)), one(Real(1));
  const Float inv_length = one / max(sqrt(dot(step, step)), Real(1e-20));
  Float share = zero;
  // As near as a cast may end, so that a body that stopped there can leave again.
  const Float touching = core * Float(Real(1.01));
  Mask moving = fast & (touching < distance_from(pose, start));
  const Mask outside = moving;
  for (int round = 0; round < kCastRounds && any(moving); ++round) {
    const Float distance = distance_from(pose, fma(step, share, start));
    const Mask close = distance < touching;
    const Float next = fma(distance - core, inv_length, share);
    moving = moving & !close;
    share = select(moving, min(next, one), share);
    moving = moving & (share < one);
  }
  return select(outside, share, one);
}

template <class Vec>
MW_INLINE Vec cast_against_fixed(const Constants& t, const Group& g, int body, Vec start,
                                 Vec step) {
  const Float radius = constants_of_body(g, body).core_radius;
  const Mask fast = (Float(Real(0)) < radius) & (radius < sqrt(dot(step, step)));
  if (!any(fast)) return step;
  // The core is half the inner sphere, so a body sunk into a face still counts as outside of it.
  const Float core = radius * Float(Real(0.5));
  Float least = Real(1);
  alignas(64) std::int32_t at[kLanes];
  const auto look = [&](const auto& pose) {
    // What got below a surface that is solid below comes up again.
    if constexpr (requires { distance_from(pose, start); }) {
      least = min(least, free_share(pose, start, step, core, fast));
    }
  };
  for (int f = 0; f < t.fixed_shapes; ++f) {
    const auto& fixed = t.fixed[f];
    for (int l = 0; l < kLanes; ++l) at[l] = fixed.row;
    visit_pose(typename ShapesOf<Vec>::Moving{}, fixed.kind, t.fixed_rows, at, nullptr, look) ||
        visit_pose(typename ShapesOf<Vec>::Ground{}, fixed.kind, t.fixed_rows, at, nullptr, look);
  }
  return select(least < Float(Real(1)), step * least, step);
}

// Takes down the shapes of bodies that go so far in this step that others may have to be cast
// against them, whatever those do.
template <class Moved>
void find_swift(const Constants& t, const Group& g, Work& w, Moved moved) {
  Float core = Real(1e18);  // the smallest
  for (int b = 0; b < t.bodies; ++b) {
    const Float radius = constants_of_body(g, b).core_radius;
    core = select(Float(Real(0)) < radius, min(radius, core), core);
  }
  const Float far = core * Float(Real(0.49));  // a little less than half of it
  w.swift_count = 0;
  for (int i = 0; i < t.colliders; ++i) {
    const auto way = moved(t.collider_body[i]);
    if (all(dot(way, way) < square(far))) continue;
    w.swift[w.swift_count++] = i;
  }
}

// `moved(other)` is how far another body goes in this step. A body that moves less than half its
// core is tested against the fast ones only. Not inlined: scenes seldom want it.
template <class Vec, class Moved>
__attribute__((noinline)) Vec cast_against_moving(const Constants& t, const Group& g, const Work& w,
                                                  int body, Vec start, Vec step, Moved moved) {
  const Float radius = constants_of_body(g, body).core_radius;
  const Mask has_core = Float(Real(0)) < radius;
  if (!any(has_core)) return step;
  const Float core = radius * Float(Real(0.5));
  Float least = Real(1);
  const bool slow = all(dot(step, step) < square(core));
  const int others = slow ? w.swift_count : t.colliders;
  alignas(64) std::int32_t at[kLanes];
  for (int k = 0; k < others; ++k) {
    const int i = slow ? w.swift[k] : k;
    const auto& c = t.collider[i];
    if (c.body == body || !may_collide(t, body, c)) continue;
    const Vec relative = step - moved(c.body);
    const Mask fast =
        has_core & (radius < sqrt(dot(relative, relative))) & !absent_lanes(g, c.body);
    if (!any(fast)) continue;
    for (int l = 0; l < kLanes; ++l) at[l] = w.pose_base[l] + c.row;
    visit_pose(typename ShapesOf<Vec>::Moving{}, c.kind, w.pose_rows, at, t.hulls,
               [&](const auto& pose) {
                 least = min(least, free_share(pose, start, relative, core, fast));
               });
  }
  return select(least < Float(Real(1)), step * least, step);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
