// A number of each body and lane that contacts raise and read: through it a contact hears of those
// that share a body with it. Only bodies that contacts can move have one, so that nothing is heard
// through the ground.
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

// [body][lane], at least 0; in the memory of impulse_part, which is unused after the last substep.
MW_INLINE Real* number_of(const Work& w, int body) { return w.impulse_part + body * kLanes; }

inline void clear_numbers(const Constants& t, const Work& w) {
  for (int b = 0; b < t.bodies; ++b) Float(Real(0)).store(number_of(w, b));
}

// Raises the numbers of a block's bodies to `value`, which is 0 outside of `lanes`.
template <bool kDense, class S, int N, class A>
MW_INLINE void raise_numbers(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                             Float value, unsigned lanes) {
  if constexpr (kDense) {
    const auto raise = [&](int body) {
      if (t.body[body].kinematic) return;
      Real* number = number_of(w, body);
      max(Float::load(number), value).store(number);
    };
    raise(s.body_b);
    if constexpr (A::kMoves) raise(s.body_a);
  } else {
    alignas(64) Real of_lane[kLanes];
    value.store(of_lane);
    const auto raise = [&](int body, int lane) {
      Real& number = number_of(w, body)[lane];
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
template <bool kDense, class S, int N, class A>
MW_INLINE Float largest_number(const Constants& t, const Work& w, const SidedBlock<S, N, A>& s,
                               unsigned lanes) {
  const Float zero(Real(0));
  if constexpr (kDense) {
    const auto number = [&](int body) {
      return t.body[body].kinematic ? zero : Float::load(number_of(w, body));
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
      const Real number = number_of(w, body)[lane];
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

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
