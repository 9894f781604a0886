// Numbers of each body and lane that contacts raise and read, by which values propagate between
// contacts that share a body. Only bodies that contacts can move have them, so that nothing
// propagates through the ground.
#pragma once

#include "kernels/rows/contact.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, int N>
MW_INLINE int body_a_of(const Work& w, const ContactBlock<S, N>& s, int lane) {
  return (s.offset_a[lane] - w.velocity_base[lane]) / S::kRow;
}
template <class S, int N>
MW_INLINE int body_b_of(const Work& w, const ContactBlock<S, N>& s, int lane) {
  return (s.offset_b[lane] - w.velocity_base[lane]) / S::kRow;
}

// Speeds of impacts; the first round in which blocks of the body need not play again.
enum class BodyNumber { speed, round };

// [body][BodyNumber][lane], at least 0; in the memory of impulse_part, which is unused after the
// last substep.
template <BodyNumber kNumber = BodyNumber::speed>
MW_INLINE Real* number_of(const Work& w, int body) {
  return w.impulse_part + (body * 2 + static_cast<int>(kNumber)) * kLanes;
}

template <BodyNumber kNumber = BodyNumber::speed>
void clear_numbers(const Constants& t, const Work& w) {
  for (int b = 0; b < t.bodies; ++b) Float(Real(0)).store(number_of<kNumber>(w, b));
}

// Raises the numbers of a block's bodies to `value`, which is 0 outside of `lanes`.
template <bool kDense, BodyNumber kNumber = BodyNumber::speed, class S, int N, class A>
MW_INLINE void raise_numbers(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                             Float value, unsigned lanes) {
  if constexpr (kDense) {
    const auto raise = [&](int body) {
      if (t.body[body].kinematic) return;
      Real* number = number_of<kNumber>(w, body);
      max(Float::load(number), value).store(number);
    };
    raise(s.body_b);
    if constexpr (A::kMoves) raise(s.body_a);
  } else {
    alignas(64) Real of_lane[kLanes];
    value.store(of_lane);
    const auto raise = [&](int body, int lane) {
      Real& number = number_of<kNumber>(w, body)[lane];
      if (!t.body[body].kinematic && number < of_lane[lane]) number = of_lane[lane];
    };
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      raise(body_b_of(w, s, lane), lane);
      if constexpr (A::kMoves) raise(body_a_of(w, s, lane), lane);
    }
  }
}

// The larger of the numbers of a block's bodies, in `lanes`; elsewhere 0 or more.
template <bool kDense, BodyNumber kNumber = BodyNumber::speed, class S, int N, class A>
MW_INLINE Float largest_number(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                               unsigned lanes) {
  const Float zero(Real(0));
  if constexpr (kDense) {
    const auto number = [&](int body) {
      return t.body[body].kinematic ? zero : Float::load(number_of<kNumber>(w, body));
    };
    const Float b = number(s.body_b);
    if constexpr (A::kMoves) {
      return max(number(s.body_a), b);
    } else {
      return b;
    }
  } else {
    alignas(64) Real largest[kLanes];
    zero.store(largest);
    const auto look = [&](int body, int lane) {
      const Real number = number_of<kNumber>(w, body)[lane];
      if (!t.body[body].kinematic && largest[lane] < number) largest[lane] = number;
    };
    for (; lanes != 0; lanes &= lanes - 1) {
      const int lane = __builtin_ctz(lanes);
      look(body_b_of(w, s, lane), lane);
      if constexpr (A::kMoves) look(body_a_of(w, s, lane), lane);
    }
    return Float::load(largest);
  }
}

// Rounds over blocks that share bodies, from 1 on: a block plays only in the lanes in which one of
// its bodies has changed in this round or the one before. So a round does nothing where nothing
// happens, whatever happens elsewhere in a world.
template <bool kDense, class S, int N, class A>
MW_INLINE unsigned lanes_to_play(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                                 unsigned lanes, int round) {
  if (lanes == 0) return 0;
  const Float last = largest_number<kDense, BodyNumber::round>(t, w, s, lanes);
  return lanes & bits(Float(Real(round)) <= last);
}
template <bool kDense, class S, int N, class A>
MW_INLINE void mark_changed(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                            unsigned lanes, int round) {
  const Float next = select(mask_from_bits(lanes), Float(Real(round + 1)), Float(Real(0)));
  raise_numbers<kDense, BodyNumber::round>(t, w, s, next, lanes);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
