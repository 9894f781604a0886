// Which bodies something touches in this step: those that contacts will meet, told when rows are
// made, and those that an impulse has reached.
#pragma once

#include "kernels/lane/ints.hpp"
#include "kernels/rows/side.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// In the lanes of `touching` contacts may act on the bodies of `sides` in this step: of rows, which
// are many. A byte is stored without asking what was there, so no store waits for the one before.
template <class A, class Sides>
MW_INLINE void mark_met(const Constants& t, const Work& w, std::uint32_t touching,
                        const Sides& sides) {
  const auto mark = [&](Ints bodies) {
    alignas(64) std::int32_t at[kLanes];
    (select(touching, bodies, Ints(t.bodies)) * Ints(kLanes) + Ints::lanes()).store(at);
    for (int l = 0; l < kLanes; ++l) w.met[at[l]] = 1;
  };
  mark(sides.body_b);
  if constexpr (A::kMoves) mark(sides.body_a);
}

// In the lanes of `touching` contacts may act on the bodies of a block in this step.
template <class S, class A, bool kDense>
MW_INLINE void mark_touched(const Work& w, std::uint32_t touching, const RowBodies& s) {
  if constexpr (kDense) {
    w.touched[s.body_b] |= touching;
    if constexpr (A::kMoves) w.touched[s.body_a] |= touching;
  } else {
    for (; touching != 0; touching &= touching - 1) {
      const int lane = __builtin_ctz(touching);
      const auto mark = [&](std::int32_t offset) {
        w.touched[(offset - w.velocity_base[lane]) / S::kRow] |= 1u << lane;
      };
      mark(s.offset_b[lane]);
      if constexpr (A::kMoves) mark(s.offset_a[lane]);
    }
  }
}

// What rows have marked becomes bits.
inline void gather_met(const Constants& t, const Work& w) {
  constexpr int kAtOnce = kLanes < 8 ? kLanes : 8;
  for (int b = 0; b < t.bodies; ++b) {
    for (int l = 0; l < kLanes; l += kAtOnce) {
      std::uint64_t bytes = 0;
      __builtin_memcpy(&bytes, w.met + b * kLanes + l, kAtOnce);
      // Byte i, 0 or 1, comes to bit 56 + i.
      const auto bits = static_cast<std::uint32_t>(bytes * 0x0102040810204080u >> 56);
      w.touched[b] |= bits << l;
    }
  }
}

// Of a block that was not sure to touch in some lanes: those in which it has an impulse after all.
template <class S, class A, bool kDense, class Block>
MW_INLINE void mark_reached(const Work& w, Block& s) {
  if (s.unsure == 0) return;
  Float most = Float::load(s.impulse[0]);
  for (int i = 1; i < Block::kPoints; ++i) most = max(most, Float::load(s.impulse[i]));
  const std::uint32_t reached = s.unsure & bits(Float(Real(0)) < most);
  s.unsure &= ~reached;
  mark_touched<S, A, kDense>(w, reached, s);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
