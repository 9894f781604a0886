// Warm starting's book-keeping: the capacity of a lane's lists, finding a manifold's stored
// impulses by key, and carrying them over to its points of now.
#pragma once

#include "kernels/lane/ints.hpp"
#include "kernels/rows/contact_block.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Offsets of the cache rows that hold the impulses of the lanes' keys; the zero row if none does.
// Keys ascend in the cache and from block to block, so each lane's cursor only moves forward.
inline void find_stored(const Constants& t, const Group& g, Work& w, ListId list,
                        std::uint32_t mask, const std::int32_t* key, std::int32_t* offset) {
  const int id = static_cast<int>(list);
  const std::int32_t* keys = g.cache[id].keys;
  const Ints wanted = Ints::load(key), lanes = Ints::lanes();
  Ints at = Ints::load(w.cursor[id]), found = Ints::load(w.key_at_cursor[id]);
  for (std::uint32_t behind; (behind = (found < wanted) & mask) != 0;) {
    at = at + select(behind, Ints(kLanes), Ints(0));
    found = gather(keys, lanes + at);
  }
  at.store(w.cursor[id]);
  found.store(w.key_at_cursor[id]);
  const Ints row = select((found == wanted) & mask, at + Ints(kernels::kFirstRow * kLanes),
                          Ints(kernels::kZeroRow * kLanes));
  const Ints size(kernels::cache_row_size(t, list));
  ((row + lanes) * size).store(offset);
}

// Drops the lanes whose list is full and counts the others.
inline std::uint32_t claim_capacity(const Constants& t, Work& w, ListId list, std::uint32_t mask) {
  std::int32_t* count = w.lane_count[static_cast<int>(list)];
  const Ints claimed = Ints::load(count);
  const std::uint32_t room = claimed < Ints(t.capacity[static_cast<int>(list)]);
  w.overflow |= mask & ~room;
  mask &= room;
  (claimed + select(mask, Ints(1), Ints(0))).store(count);
  return mask;
}

template <int N>
struct StoredImpulses {
  Float normal[N], tangent[2], twist;
  std::uint32_t struck;  // lanes in which they are of an impact
};

// The impulses of an impact end with it: carried on, they would jam bodies between one another with
// many times their momentum, which rounding loses.
template <int N>
MW_INLINE void end_impact(StoredImpulses<N>& s) {
  const Float zero(Real(0));
  const Mask ends = mask_from_bits(s.struck);
  for (Float& x : s.normal) x = select(ends, zero, x);
  for (Float& x : s.tangent) x = select(ends, zero, x);
  s.twist = select(ends, zero, s.twist);
}

// A point's friction impulse is kept as a world vector, since its tangents rotate with it.
template <class S>
MW_INLINE void carry_impulses(const Real* rows, const std::int32_t* stored,
                              const Manifold<GeometryOf<S>, 1>& m, ContactBlock<S, 1>&,
                              StoredImpulses<1>& out) {
  const Float zero(Real(0));
  typename S::Vec kept;
  Float unused;
  out.tangent[1] = out.twist = zero;
  if constexpr (S::kDim == 3) {
    load_rows4(rows, stored, out.normal[0], kept.x, kept.y, kept.z);
    out.tangent[0] = dot(kept, m.tangent);
    out.tangent[1] = dot(kept, cross(m.normal, m.tangent));
  } else {
    load_rows4(rows, stored, out.normal[0], kept.x, kept.y, unused);
    out.tangent[0] = cross(m.normal, kept);
  }
  out.struck = bits(out.normal[0] < zero);
  out.normal[0] = select(m.valid[0], abs(out.normal[0]), zero);
}

// Points are told apart by their place on the reference feature. Guards have none: they begin
// without an impulse, and nothing is carried from them.
template <class S, int N>
MW_INLINE void carry_impulses(const Real* rows, const std::int32_t* stored,
                              const Manifold<GeometryOf<S>, N>& m, ContactBlock<S, N>& s,
                              StoredImpulses<N>& out) {
  const Float zero(Real(0));
  Float old_x[4], old_y[4] = {zero, zero, zero, zero}, old[4], code, unused;
  out.tangent[1] = out.twist = zero;
  if constexpr (S::kDim == 3) {
    load_rows8(rows, stored, old_x[0], old_x[1], old_x[2], old_x[3], old_y[0], old_y[1], old_y[2],
               old_y[3]);
    load_rows8(rows + 8, stored, old[0], old[1], old[2], old[3], code, out.tangent[0],
               out.tangent[1], out.twist);
  } else {
    load_rows4(rows, stored, old_x[0], old_x[1], old[0], old[1]);
    load_rows4(rows + 4, stored, code, out.tangent[0], unused, unused);
  }
  const Mask same = code == m.code;
  Float sum = zero, least = zero;
  for (int j = 0; j < N; ++j) least = min(old[j], least);
  out.struck = bits(least < zero);
  for (int i = 0; i < N; ++i) {
    // From the nearest; the first of several in one place, since points that a manifold does not
    // have repeat its first with no impulse.
    Float x = zero, nearest = m.match_distance2;
    for (int j = 0; j < N; ++j) {
      const Float dx = old_x[j] - m.feature_x[i], dy = old_y[j] - m.feature_y[i];
      const Float distance2 = fma(dx, dx, dy * dy);
      x = select(distance2 < nearest, abs(old[j]), x);
      nearest = min(distance2, nearest);
    }
    out.normal[i] = select(same & m.valid[i] & !m.guard[i], x, zero);
    sum = sum + out.normal[i];
    select(m.guard[i], m.feature_x[0], m.feature_x[i]).store(s.feature_x[i]);
    select(m.guard[i], m.feature_y[0], m.feature_y[i]).store(s.feature_y[i]);
  }
  const Mask carried = zero < sum;
  for (Float& impulse : out.tangent) impulse = select(carried, impulse, zero);
  out.twist = select(carried, out.twist, zero);
  m.code.store(s.code);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
