// A pass over the blocks of a list, in their order. Where neighbours are apart (apart.hpp) the
// velocities of the second are loaded before the first is solved, which is a long chain of
// operations that wait for each other. The bits are those of one after the other.
#pragma once

#include "kernels/rows/contact.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Points of blocks of which the registers hold two: of more, solving two at once costs more than it
// hides (measured, docs/kernels.md).
#if defined(MW_ISA_AVX512)
inline constexpr int kMostInTwos = 2;
#else
inline constexpr int kMostInTwos = 1;
#endif

template <bool kDense, Pass kPass, class S, int N, class A>
MW_INLINE void solve_two_blocks(const Constants& t, Work& w, SidedBlock<S, N, A>& first,
                                SidedBlock<S, N, A>& second) {
  RowVelocities<S, A, kDense> of_first(w, first), of_second(w, second);
  solve_rows<kDense, kPass>(t, w, first, of_first);
  solve_rows<kDense, kPass>(t, w, second, of_second);
  of_first.store(w, first);
  of_second.store(w, second);
}

// Calls finish(i) once block i is solved.
template <bool kDense, Pass kPass, class Block, class Finish>
MW_INLINE void solve_in_twos(const Constants& t, Work& w, const BlockList& list, Finish finish) {
  const auto block = [&](int i) -> Block& { return block_at<Block>(list, i); };
  for (int i = 0; i < list.count;) {
    const int first = i;
    if (Block::kPoints <= kMostInTwos && i + 1 < list.count && block(i + 1).apart) {
      solve_two_blocks<kDense, kPass>(t, w, block(i), block(i + 1));
      i += 2;
    } else {
      solve_block<kDense, kPass>(t, w, block(i++));
    }
    for (int k = first; k < i; ++k) finish(k);
  }
}

// The velocities of each block are loaded before the one ahead of it is solved, not only of every
// second: where the registers hold those of both, too, beside what the rows need (measured,
// docs/kernels.md). Calls finish(i) as above.
template <bool kDense, Pass kPass, class Block, class Finish>
MW_INLINE void solve_ahead(const Constants& t, Work& w, const BlockList& list, Finish finish) {
  if (list.count == 0) return;
  const auto block = [&](int i) -> Block& { return block_at<Block>(list, i); };
  auto v = velocities_of<kDense>(w, block(0));
  for (int i = 0; i < list.count; ++i) {
    const bool last = i + 1 == list.count;
    if (!last && block(i + 1).apart) {
      const auto next = velocities_of<kDense>(w, block(i + 1));
      solve_rows<kDense, kPass>(t, w, block(i), v);
      v.store(w, block(i));
      v = next;
    } else {
      solve_rows<kDense, kPass>(t, w, block(i), v);
      v.store(w, block(i));
      if (!last) v = velocities_of<kDense>(w, block(i + 1));
    }
    finish(i);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
