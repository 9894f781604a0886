// Velocities of the two sides that rows act on, in either layout.
#pragma once

#include "kernels/rows/side.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
MW_INLINE Velocity<S> load_velocity(const Real* array, const std::int32_t* offset, int body) {
  if constexpr (kDense) {
    return load_velocity_dense<S>(array + body * (S::kDim + S::kAng) * kLanes);
  } else {
    return load_velocity_row(S{}, array, offset);
  }
}
// In the dense layout a lane outside of `mask` keeps its bits; in rows it moves the dummy.
template <class S, bool kDense>
MW_INLINE void store_velocity(Real* array, const std::int32_t* offset, int body, std::uint32_t mask,
                              const Velocity<S>& v) {
  if constexpr (kDense) {
    Real* to = array + body * (S::kDim + S::kAng) * kLanes;
    if (mask == kAllLanes) {
      store_velocity_dense(to, v);
    } else {
      store_velocity_dense(to, select(mask_from_bits(mask), v, load_velocity_dense<S>(to)));
    }
  } else {
    store_velocity_row(S{}, array, offset, v);
  }
}

template <class S, class A>
struct SideVelocities {
  SideVelocity<S, A> a;
  Velocity<S> b;
};

// Outside of `lanes` v is as before, to the sign of its zeros.
MW_INLINE void keep_other_lanes(Mask, Still, Still) {}
template <class S>
MW_INLINE void keep_other_lanes(Mask lanes, const Velocity<S>& before, Velocity<S>& v) {
  v = select(lanes, v, before);
}
template <class Sides>
MW_INLINE void keep_other_lanes_of_sides(Mask lanes, const Sides& before, Sides& v) {
  keep_other_lanes(lanes, before.b, v.b);
  keep_other_lanes(lanes, before.a, v.a);
}

// From `array`, which is laid out like Work::velocity.
template <class S, class A, bool kDense>
MW_INLINE SideVelocities<S, A> load_sides(const Real* array, const RowBodies& s) {
  SideVelocities<S, A> out;
  out.b = load_velocity<S, kDense>(array, s.offset_b, s.body_b);
  if constexpr (A::kMoves) out.a = load_velocity<S, kDense>(array, s.offset_a, s.body_a);
  return out;
}

// The velocities of a block, loaded once and stored once.
template <class S, class A, bool kDense>
struct RowVelocities : SideVelocities<S, A> {
  static constexpr bool kIsDense = kDense;
  using SideVelocities<S, A>::a, SideVelocities<S, A>::b;

  MW_INLINE RowVelocities(const Work& w, const RowBodies& s)
      : SideVelocities<S, A>(load_sides<S, A, kDense>(w.velocity, s)) {}

  MW_INLINE void store(Work& w, const RowBodies& s) const {
    store_velocity<S, kDense>(w.velocity, s.offset_b, s.body_b, s.mask, b);
    if constexpr (A::kMoves) {
      store_velocity<S, kDense>(w.velocity, s.offset_a, s.body_a, s.mask, a);
    }
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
