// Rows of one manifold act on each other: what an impulse at one point does to the speeds at the
// others.
#pragma once

#include "kernels/rows/contact_block.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Row k changed by d: the speeds of the rows after it follow.
template <class S, int N>
MW_INLINE void couple_following(const ContactBlock<S, N>& s, int k, Float d, Float* speed) {
  int at = k * N - k * (k + 1) / 2;
  for (int j = k + 1; j < N; ++j) speed[j] = fma(Float::load(s.cross_k[at++]), d, speed[j]);
}

// Every other row follows when row k changes by d.
template <class S, int N>
MW_INLINE void couple_all(const ContactBlock<S, N>& s, int k, Float d, Float* speed) {
  for (int j = 0; j < k; ++j) {
    const int at = j * N - j * (j + 1) / 2 + (k - j - 1);
    speed[j] = fma(Float::load(s.cross_k[at]), d, speed[j]);
  }
  couple_following(s, k, d, speed);
}

// Of two points that are almost one more than this many roundings would be lost.
inline constexpr Real kMostGain = Real(4096);

template <class S, class A>
MW_INLINE void put_pair_gain(SidedBlock<S, 2, A>& s) {
  const Float one(Real(1)), k = Float::load(s.cross_k[0]);
  const Float shared = (k * k) * (Float::load(s.mass[0]) * Float::load(s.mass[1]));
  const Float apart = one - shared, least(Real(1) / kMostGain);
  select(least < apart, one / max(apart, least), Float(Real(0))).store(s.pair_gain);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
