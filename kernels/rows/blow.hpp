// Blows: what comes, or goes, so suddenly that one sweep over a manifold's points, one after the
// other, would turn the body about the first of them. The points are solved together first: by one
// impulse at all of them, which is the answer where the load is in their middle, and rounds of
// Gauss-Seidel.
#pragma once

#include "kernels/rows/couple.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kBlowRounds = 16;
// Of an impulse: changes that end the rounds.
inline constexpr Real kBlowTolerance = sizeof(Real) == 4 ? Real(1e-5) : Real(1e-11);

// What a blow changes, zero in other lanes.
template <int N>
struct Blow {
  Float impulse[N], speed[N];  // N s, m/s
};

// Of the lanes of a blow, with the speeds of the points along the normal, what they are to be at
// most, the impulses so far, and the most that each may become.
template <class S, int N>
__attribute__((noinline)) Blow<N> find_blow(const ContactBlock<S, N>& s, Mask lanes,
                                            const Float* bias, const Float* speed,
                                            const Float* impulse, const Float* most) {
  const Float zero(Real(0)), one(Real(1)), tiny(Real(1e-30));
  Float mass[N], inv[N], response[N], closing[N];
  Blow<N> out;
  for (int i = 0; i < N; ++i) {
    mass[i] = select(lanes & (zero < most[i]), Float::load(s.mass[i]), zero);
    inv[i] = select(zero < mass[i], one / max(mass[i], tiny), zero);
    response[i] = inv[i];
    closing[i] = speed[i] + max(bias[i], zero);
  }
  const auto there = [&](int i) { return select(zero < mass[i], one, zero); };
  for (int i = 0; i < N; ++i) couple_all(s, i, there(i), response);
  Float sum_speed = zero, sum_response = zero;
  for (int i = 0; i < N; ++i) {
    sum_speed = fma(closing[i], there(i), sum_speed);
    sum_response = fma(response[i], there(i), sum_response);
  }
  // No point may pull.
  Float least(Real(1e30));
  for (int i = 0; i < N; ++i) least = min(select(zero < mass[i], impulse[i], least), least);
  const Float even = select(lanes, max(-sum_speed / max(sum_response, tiny), -least), zero);
  for (int i = 0; i < N; ++i) {
    out.impulse[i] = even * there(i);
    closing[i] = fma(response[i], even, closing[i]);
  }
  const Float tolerance(kBlowTolerance);
  Mask open = lanes;
  for (int round = 0; round < kBlowRounds && any(open); ++round) {
    Mask changed = mask_from_bits(0);
    for (int i = 0; i < N; ++i) {
      const Float given = impulse[i] + out.impulse[i];
      const Float wanted = min(max(fnma(mass[i], closing[i], given), zero), most[i]);
      const Float change = select(open, wanted - given, zero);
      changed = changed | (tolerance * max(wanted, given) < abs(change));
      out.impulse[i] = out.impulse[i] + change;
      closing[i] = fma(inv[i], change, closing[i]);
      couple_all(s, i, change, closing);
    }
    open = open & changed;
  }
  for (int i = 0; i < N; ++i) {
    out.speed[i] = select(lanes, closing[i] - (speed[i] + max(bias[i], zero)), zero);
  }
  return out;
}
// The same of copies, so that the arrays of the caller can stay in registers.
template <class S, int N>
MW_INLINE Blow<N> settle_blow(const ContactBlock<S, N>& s, Mask lanes, const Float* bias,
                              const Float* speed, const Float* impulse, const Float* most) {
  Float copy[4][N];
  for (int i = 0; i < N; ++i) {
    copy[0][i] = bias[i], copy[1][i] = speed[i], copy[2][i] = impulse[i], copy[3][i] = most[i];
  }
  return find_blow(s, lanes, copy[0], copy[1], copy[2], copy[3]);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
