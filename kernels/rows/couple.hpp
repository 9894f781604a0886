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

// By so much stiffer are both of two points that are almost one: what an impulse does to the
// difference of their speeds is lost to rounding.
inline constexpr Real kStiffer = sizeof(Real) == 4 ? Real(1.0 / 4096) : Real(1e-7);

template <class S, class A>
MW_INLINE void put_pair(SidedBlock<S, 2, A>& s) {
  const Float one(Real(1)), k = Float::load(s.cross_k[0]), stiffer(kStiffer);
  const Float shared = (k * k) * (Float::load(s.mass[0]) * Float::load(s.mass[1]));
  const Float share = one / (one + select(one - shared < stiffer + stiffer, stiffer, Real(0)));
  (share / fnma(shared, share * share, one)).store(s.pair.gain);
  (k * share).store(s.pair.coupling);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
