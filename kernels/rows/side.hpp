// The sides of a row: what it acts on at either end. A side kind says what rows keep of it, which
// velocity it has, how fast that is along a row, and what an impulse does to it. B of every row is
// Free; what A adds to a row is left out where it does not move (kMoves).
//   Fixed  nothing moves
//   Free   a body that moves freely
// One more kind that moves needs its overloads here, and what a contact has of it: ContactSide
// (contact_block.hpp), SideState (sides.hpp), SideArms (approach.hpp).
#pragma once

#include <type_traits>

#include "kernels/rows/body_rows.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct Fixed {
  static constexpr bool kMoves = false;
};
struct Free {
  static constexpr bool kMoves = true;
};

// Whose velocities rows act on.
struct alignas(64) RowBodies {
  std::int32_t offset_a[kLanes], offset_b[kLanes];  // velocity rows; dummy in inactive lanes
  std::uint32_t mask;                               // active lanes
  std::int32_t body_a, body_b;                      // dense layout: the bodies of every lane
};

// ---- what rows keep of a side ------------------------------------------------------------------

template <class S, class Side>
struct SideRows {};
template <class S>
struct alignas(64) SideRows<S, Free> {
  Real inv_mass[kLanes];
  Real inertia[S::kInertia][kLanes];  // inverse
};

template <class S>
MW_INLINE void put_side(const BodyRow<S>& body, SideRows<S, Free>& rows) {
  store(rows.inertia[0], body.inertia);
  body.inv_mass.store(rows.inv_mass);
}
template <class S>
MW_INLINE typename S::Inertia inertia_of(const SideRows<S, Free>& rows) {
  return load_as<typename S::Inertia>(rows.inertia[0]);
}

// ---- its velocity ------------------------------------------------------------------------------

struct Still {};
template <class S, class Side>
using SideVelocity = std::conditional_t<Side::kMoves, Velocity<S>, Still>;

MW_INLINE Still select(Mask, Still, Still) { return {}; }

// Of B against A: of their centres of mass, and of their rotations.
template <class S>
MW_INLINE typename S::Vec relative_velocity(const Velocity<S>& a, const Velocity<S>& b) {
  return b.v - a.v;
}
template <class S>
MW_INLINE typename S::Vec relative_velocity(Still, const Velocity<S>& b) {
  return b.v;
}
template <class S>
MW_INLINE typename S::Ang relative_spin(const Velocity<S>& a, const Velocity<S>& b) {
  return b.w - a.w;
}
template <class S>
MW_INLINE typename S::Ang relative_spin(Still, const Velocity<S>& b) {
  return b.w;
}

template <class S>
MW_INLINE typename S::Vec point_velocity(const Velocity<S>& v, typename S::Vec arm) {
  return v.v + cross(v.w, arm);
}

// ---- impulses ----------------------------------------------------------------------------------

// Adds an impulse p, or `amount` along a direction, with this moment about the centre of mass.
template <class S, class Kind>
MW_INLINE void add_moment(const SideRows<S, Kind>& side, typename S::Ang moment, Velocity<S>& v) {
  v.w = add_applied(v.w, inertia_of(side), moment);
}
template <class S, class Kind>
MW_INLINE void add_impulse(const SideRows<S, Kind>& side, typename S::Vec p, typename S::Ang moment,
                           Velocity<S>& v) {
  v.v = fma(p, Float::load(side.inv_mass), v.v);
  add_moment(side, moment, v);
}
template <class S, class Kind>
MW_INLINE void add_impulse(const SideRows<S, Kind>& side, typename S::Vec direction, Float amount,
                           typename S::Ang moment, Velocity<S>& v) {
  v.v = fma(direction, amount * Float::load(side.inv_mass), v.v);
  add_moment(side, moment, v);
}

// Takes it off: what B gets is taken off A. Not by adding a negated impulse, from which the sign of
// a zero could differ.
template <class S, class Kind>
MW_INLINE void take_moment(const SideRows<S, Kind>& side, typename S::Ang moment, Velocity<S>& v) {
  v.w = sub_applied(v.w, inertia_of(side), moment);
}
template <class S, class Kind>
MW_INLINE void take_impulse(const SideRows<S, Kind>& side, typename S::Vec p,
                            typename S::Ang moment, Velocity<S>& v) {
  v.v = fnma(p, Float::load(side.inv_mass), v.v);
  take_moment(side, moment, v);
}
template <class S, class Kind>
MW_INLINE void take_impulse(const SideRows<S, Kind>& side, typename S::Vec direction, Float amount,
                            typename S::Ang moment, Velocity<S>& v) {
  v.v = fnma(direction, amount * Float::load(side.inv_mass), v.v);
  take_moment(side, moment, v);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
