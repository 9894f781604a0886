// Casts: a body that moves farther in a collision pass than it is thick could pass through a wall,
// so it is swept against fixed shapes, and on request against moving shapes. It stops where it
// first touches one. Against what is solid below, contacts with a speculative margin hold at any
// speed unless a body rotates: planes and height fields are looked at for what rows of contacts
// miss.
//
// Each shape of the body is swept as it is, along its path and through its rotation in the step.
// The separation comes from the general convex method, so any two shapes can meet. A shape that
// touches already is swept as a smaller copy of itself about its inside, so that it can slide, roll
// and leave, but cannot sink. What is undecided after the last round stops where it was known to be
// free. The rest of the step's motion is dropped; velocities stay, and the next step's contact acts
// on them.
//
// A moving shape is taken to translate without rotation while the step lasts: its rotation matters
// little to a body that crosses its own size meanwhile.
//
// Bodies on joints stop later, where a ball of half their half thickness touches, and rotations of
// theirs are not looked at: a body that stops alone stretches its joints.
#pragma once

#include "kernels/lane/space.hpp"
#include "kernels/work/activity.hpp"
#include "kernels/work/constants.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// How a body moves in a step. In the plane z, and x and y of rotations, are 0.
struct CastMotion {
  Vec3 from;   // centre of mass at the start, m
  Vec3 step;   // m
  Vec3 turn;   // rad
  Vec3 ahead;  // rad, by which pose rows are turned already (work/half_turn.hpp)
};

// Nearer than this a shape touches what it is cast against, and contacts act on it as on any other.
// `core`: BodyConstants::half_thickness.
MW_INLINE Float cast_gap(const Constants& t, Float core) {
  return min(Float(t.margin), core) * Float(Real(0.125));
}

// The share of its motion that a body may go before it touches a fixed shape, 1 where none is in
// its way. Only lanes of `fast` are looked at. `held`: where contacts or joints act on it.
Float free_share_of_fixed(const Constants& t, const Group& g, const Work& w, int body,
                          const CastMotion& motion, Mask fast, Mask held);
// The same against a moving collider; motion.step: relative to it.
Float free_share_of_moving(const Constants& t, const Group& g, const Work& w, int body, int other,
                           const CastMotion& motion, Mask fast, Mask held);

MW_INLINE Vec3 in_space(Vec3 v) { return v; }
MW_INLINE Vec3 in_space(Vec2 v) { return {v.x, v.y, Real(0)}; }
MW_INLINE Vec3 axis_angle(Vec3 turn) { return turn; }
MW_INLINE Vec3 axis_angle(Float turn) { return {Real(0), Real(0), turn}; }

// Contacts look ahead along straight lines. Points of a body that turns by an angle a leave theirs
// by up to (radius - core) a^2 / 2, and rods rotate through walls when that exceeds their
// thickness.
template <class Vec, class Ang>
MW_INLINE Float cast_against_fixed(const Constants& t, const Group& g, const Work& w, int body,
                                   Vec start, Vec step, Ang turn, Ang ahead, Mask held) {
  const auto& constants = constants_of_body(g, body);
  const Float core = constants.half_thickness, two(Real(2));
  Float bend = (Float(constants.radius) - core) * dot(turn, turn);
  if (t.body[body].jointed) bend = Real(0);
  const Mask fast =
      (Float(Real(0)) < core) & ((core < sqrt(dot(step, step))) | (two * core < bend));
  if (!any(fast)) return Real(1);
  return free_share_of_fixed(t, g, w, body,
                             {in_space(start), in_space(step), axis_angle(turn), axis_angle(ahead)},
                             fast, held);
}

// Does any shape of the body collide with this one, by their filters?
MW_INLINE bool may_collide(const Constants& t, int body, const kernels::ColliderTable& other) {
  for (int i = t.first_collider[body]; i < t.first_collider[body + 1]; ++i) {
    const auto& own = t.collider[i];
    if ((own.category & other.mask) != 0 && (other.category & own.mask) != 0) return true;
  }
  return false;
}

// Takes down the shapes of bodies that go so far in this step that others may have to be cast
// against them, whatever those do.
template <class Moved>
void find_swift(const Constants& t, const Group& g, Work& w, Moved moved) {
  Float core = Real(1e18);  // the smallest
  for (int b = 0; b < t.bodies; ++b) {
    const Float radius = constants_of_body(g, b).half_thickness;
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
template <class Vec, class Ang, class Moved>
__attribute__((noinline)) Float cast_against_moving(const Constants& t, const Group& g,
                                                    const Work& w, int body, Vec start, Vec step,
                                                    Ang turn, Ang ahead, Mask held, Moved moved) {
  const Float core = constants_of_body(g, body).half_thickness;
  const Mask has_core = Float(Real(0)) < core;
  Float share(Real(1));
  if (!any(has_core)) return share;
  const bool slow = all(dot(step, step) < square(core * Float(Real(0.5))));
  const int others = slow ? w.swift_count : t.colliders;
  for (int k = 0; k < others; ++k) {
    const int i = slow ? w.swift[k] : k;
    const auto& c = t.collider[i];
    if (c.body == body || !may_collide(t, body, c)) continue;
    const Vec relative = step - moved(c.body);
    const Mask fast = has_core & (core < sqrt(dot(relative, relative))) & !absent_lanes(g, c.body);
    if (!any(fast)) continue;
    share = min(share, free_share_of_moving(t, g, w, body, i,
                                            {in_space(start), in_space(relative), axis_angle(turn),
                                             axis_angle(ahead)},
                                            fast, held));
  }
  return share;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
