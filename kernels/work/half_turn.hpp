// Contacts are found with bodies turned to where they will be half a step on.
//
// Rows are linear in the angle. Of a body that turns by an angle a in a step, a point at the arm r
// leaves its tangent by r a^2 / 2 at the step's end; of the tangent half way, by r a^2 / 8 at both
// ends. What comes down next is found better, too, and the inverse inertia is that of the middle.
// Separations are taken back to the step's start along their rows. Bodies that turn little stay as
// they are: at rest nothing changes and nothing is paid for it. So do centred balls, and bodies of
// plans with joints, whose rows turn with the substeps: ahead of them, wheels of car3d brake (32.9
// m in 10 s, where short steps say 34.7, against 35.0).
#pragma once

#include "kernels/work/constants.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kLeastTurn = Real(0.02);  // rad in half a step, below it none
inline constexpr Real kMostTurn = Real(0.5);    // rad; what spins faster is turned by that

// Whether contacts of this step are found ahead. Contacts that are recorded for the user are those
// of now, and so are those of robots.
MW_INLINE bool looks_ahead(const Constants& t, const Work& w) {
  const bool recorded = w.recorder && !w.recorder->places;
  return t.looks_ahead && !recorded;
}

// The angle that a body turns by in half a step, as rows take it; 0 in lanes that turn little.
MW_INLINE Vec3 half_turn(const Constants& t, Vec3 spin) {
  const Vec3 angle = spin * Float(t.dt * Real(0.5));
  const Float square = dot(angle, angle), most(kMostTurn);
  const Mask turns = Float(kLeastTurn * kLeastTurn) < square;
  if (!any(turns)) return zero_of<Vec3>();
  const Float share = most / sqrt(max(square, most * most));
  return select(turns, angle * share, zero_of<Vec3>());
}
MW_INLINE Float half_turn(const Constants& t, Float spin) {
  const Float angle = spin * Float(t.dt * Real(0.5));
  const Mask turns = Float(kLeastTurn) < abs(angle);
  return select(turns, clamp(angle, -kMostTurn, kMostTurn), Float(Real(0)));
}

// Turns q by it, where it is any.
MW_INLINE Quat turned(Quat q, Vec3 angle) {
  const Mask turns = Float(Real(0)) < dot(angle, angle);
  return any(turns) ? select(turns, rotate_by(q, angle), q) : q;
}
MW_INLINE Rot2 turned(Rot2 q, Float angle) {
  const Mask turns = Float(Real(0)) < abs(angle);
  return any(turns) ? select(turns, rotate_by(q, angle), q) : q;
}

// The orientation that shapes and inverse inertias of this step have.
template <class Orientation, class Spin>
MW_INLINE Orientation orientation_ahead(const Constants& t, const Work& w, Orientation q,
                                        Spin spin) {
  return looks_ahead(t, w) ? turned(q, half_turn(t, spin)) : q;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
