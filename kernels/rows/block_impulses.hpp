// The numbers of a block that a solver pass changes, as they were.
#pragma once

#include "kernels/rows/contact_impulses.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, int N>
struct alignas(64) BlockImpulses {
  Float normal[N], gap[N], tangent[S::kTangents], twist;
  std::uint32_t lanes;  // in which it has been solved again since

  MW_INLINE void load(const ContactBlock<S, N>& s) {
    for (int i = 0; i < N; ++i) normal[i] = Float::load(s.impulse[i]);
    for (int i = 0; i < N; ++i) gap[i] = Float::load(s.gap[i]);
    for (int c = 0; c < S::kTangents; ++c) tangent[c] = Float::load(s.tangent_impulse[c]);
    if constexpr (ContactBlock<S, N>::kTwist) twist = Float::load(s.twist_impulse);
    lanes = 0;
  }
  // In the other lanes.
  MW_INLINE void restore(Mask changed, ContactBlock<S, N>& s) const {
    const auto keep = [&](Float before, Real* x) {
      select(changed, Float::load(x), before).store(x);
    };
    for (int i = 0; i < N; ++i) keep(normal[i], s.impulse[i]), keep(gap[i], s.gap[i]);
    for (int c = 0; c < S::kTangents; ++c) keep(tangent[c], s.tangent_impulse[c]);
    if constexpr (ContactBlock<S, N>::kTwist) keep(twist, s.twist_impulse);
  }
  // What the impulses have changed by since does to `v`.
  template <class A, class Velocities>
  MW_INLINE void apply_changes(const SidedBlock<S, N, A>& s, bool friction, Velocities& v) const {
    Float d[N];
    for (int i = 0; i < N; ++i) d[i] = Float::load(s.impulse[i]) - normal[i];
    apply_normal(s, d, v);
    if (!friction) return;
    Float along[2] = {Float(Real(0)), Float(Real(0))}, about(Real(0));
    for (int c = 0; c < S::kTangents; ++c)
      along[c] = Float::load(s.tangent_impulse[c]) - tangent[c];
    if constexpr (ContactBlock<S, N>::kTwist) about = Float::load(s.twist_impulse) - twist;
    apply_friction(s, along, about, v);
  }
};

template <class S, int N>
MW_INLINE BlockImpulses<S, N>& impulses_before(const BlockList& list, int i) {
  return reinterpret_cast<BlockImpulses<S, N>*>(list.impulses_before)[i];
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
