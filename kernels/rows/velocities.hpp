// Velocities of the two bodies that rows act on, in either layout.
#pragma once

#include "kernels/rows/slot.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct VelocityPair {
  Velocity<S> a, b;
};

// From `array`, which is laid out like Work::velocity. Not kPair: A is not there.
template <class S, bool kPair, bool kDense>
MW_INLINE VelocityPair<S> load_two(const Real* array, const SlotBodies& s) {
  constexpr int kBlock = (S::kDim + S::kAng) * kLanes;
  VelocityPair<S> out;
  if constexpr (kDense) {
    out.b = load_velocity_dense<S>(array + s.body_b * kBlock);
    if constexpr (kPair) out.a = load_velocity_dense<S>(array + s.body_a * kBlock);
  } else {
    out.b = load_velocity_row(S{}, array, s.offset_b);
    if constexpr (kPair) out.a = load_velocity_row(S{}, array, s.offset_a);
  }
  return out;
}

// The two bodies of a slot, loaded once and stored once.
template <class S, bool kPair, bool kDense>
struct TwoVelocities : VelocityPair<S> {
  using VelocityPair<S>::a, VelocityPair<S>::b;

  MW_INLINE TwoVelocities(const Work& w, const SlotBodies& s)
      : VelocityPair<S>(load_two<S, kPair, kDense>(w.velocity, s)) {}

  // In the dense layout a lane without this contact keeps its bits; in rows it moves the dummy.
  MW_INLINE void store(Work& w, const SlotBodies& s) const {
    constexpr int kBlock = (S::kDim + S::kAng) * kLanes;
    if constexpr (kDense) {
      Real* to_b = w.velocity + s.body_b * kBlock;
      Real* to_a = w.velocity + s.body_a * kBlock;
      if (s.mask == kAllLanes) {
        store_velocity_dense(to_b, b);
        if constexpr (kPair) store_velocity_dense(to_a, a);
      } else {
        const Mask active = mask_from_bits(s.mask);
        store_velocity_dense(to_b, select(active, b, load_velocity_dense<S>(to_b)));
        if constexpr (kPair) {
          store_velocity_dense(to_a, select(active, a, load_velocity_dense<S>(to_a)));
        }
      }
    } else {
      store_velocity_row(S{}, w.velocity, s.offset_b, b);
      if constexpr (kPair) store_velocity_row(S{}, w.velocity, s.offset_a, a);
    }
  }
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
