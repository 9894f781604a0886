// Which corner of a hull is farthest along a direction: the first of those that are.
//
// Lanes usually have different hulls, and few lanes need an answer. Then each of these is served in
// turn: lanes hold corners of its hull (lane/reduce.hpp), or a map lists few corners of a large
// one. If all lanes have the same hull and most need an answer, each corner is compared in all
// lanes at once. The answer is the same in all cases, since a corner's reach is computed alike.
#pragma once

#include "kernels/lane/reduce.hpp"
#include "kernels/shape/hull_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// The largest of some numbers, and the first that is as large.
struct First {
  Float value = Real(-1e30), index = Real(0);
  MW_INLINE void take(Float x, Float i) {
    const Mask more = value < x;
    value = max(x, value);
    index = select(more, i, index);
  }
};
MW_INLINE Float along(const HullQuad& u, Vec3 l) { return fma(u.x, l.x, fma(u.y, l.y, u.z * l.z)); }

inline Float farthest_of_shared(const HullTables& t, Vec3 l) {
  // One after the other would wait for each comparison.
  First best[4];
  const auto take = [&](First& of, int i) {
    of.take(along(corner_of(t, i), l), Float(static_cast<Real>(i)));
  };
  int i = 0;
  for (; i + 4 <= t.most_corners; i += 4) {
    for (int c = 0; c < 4; ++c) take(best[c], i + c);
  }
  for (int c = 0; i < t.most_corners; ++c, ++i) take(best[c], i);
  for (int c = 1; c < 4; ++c) {
    const Mask first = (best[c].value == best[0].value) & (best[c].index < best[0].index);
    best[0].take(best[c].value, best[c].index);
    best[0].index = select(first, best[c].index, best[0].index);
  }
  return best[0].index;
}

// Of one lane's hull, with lanes for its corners.
MW_INLINE Real farthest_side_by_side(const Real* blocks, int corners, Real x, Real y, Real z) {
  constexpr int kBlock = kernels::kCornerBlock;
  const Float lx(x), ly(y), lz(z);
  First best;
  for (int i = 0; i < corners; i += kBlock) {
    for (int k = 0; k < kBlock; k += kLanes) {
      const Real* at = blocks + 3 * i + k;
      const HullQuad u{Float::load_unaligned(at), Float::load_unaligned(at + kBlock),
                       Float::load_unaligned(at + 2 * kBlock), Real(0)};
      best.take(along(u, {lx, ly, lz}), Float(static_cast<Real>(i + k)));
    }
  }
  return index_of_largest(best.value, best.index + lane_numbers());
}
inline Real farthest_listed(const Real* rows, std::int32_t map, std::int32_t first, Real x, Real y,
                            Real z) {
  const MapList list = map_list(rows, map, x, y, z);
  Real most = Real(-1e30), best = Real(0);
  for (int k = 0; k < list.count; ++k) {
    const Real* u = rows + first + 4 * static_cast<std::int32_t>(list.numbers[k]);
    const Real reach = fma(u[0], x, fma(u[1], y, u[2] * z));
    best = most < reach ? list.numbers[k] : best;
    most = most < reach ? reach : most;
  }
  return best;
}

// `lanes`: where the answer counts.
inline Float farthest_corner(const HullTables& t, Vec3 l, Mask lanes) {
  const unsigned asked = bits(lanes);
  if (t.shared && !t.corners_mapped && 2 * __builtin_popcount(asked) > kLanes) {
    return farthest_of_shared(t, l);
  }
  alignas(64) Real x[kLanes], y[kLanes], z[kLanes], index[kLanes] = {};
  l.x.store(x), l.y.store(y), l.z.store(z);
  for (unsigned left = asked; left != 0; left &= left - 1) {
    const int i = __builtin_ctz(left);
    index[i] = t.corner_map[i] > 0
                   ? farthest_listed(t.rows, t.corner_map[i], t.first_corner[i], x[i], y[i], z[i])
                   : farthest_side_by_side(t.rows + t.block[i], t.corners[i], x[i], y[i], z[i]);
  }
  return Float::load(index);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
