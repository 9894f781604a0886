// Warm starting's book-keeping: finding a manifold's stored impulses by key, and the capacity of a
// lane's lists.
#pragma once

#include "kernels/rows/slot.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Offsets of the cache rows that hold the impulses of the lanes' keys; the zero row if none does.
// Keys ascend in the cache and from slot to slot, so each lane's cursor only moves forward.
inline void find_stored(const Tables& t, const Group& g, Work& w, ListId list, std::uint32_t mask,
                        const std::int32_t* key, std::int32_t* offset) {
  const int id = static_cast<int>(list);
  const int capacity = t.capacity[id];
  const int row = kernels::cache_row_size(t.dimension, list);
  for (int l = 0; l < kLanes; ++l) {
    int found = capacity;
    if ((mask >> l) & 1u) {
      const std::int32_t* keys = g.cache[id].keys + l * (capacity + 1);
      std::int32_t at = w.cursor[id][l];
      while (keys[at] < key[l]) ++at;
      w.cursor[id][l] = at;
      if (keys[at] == key[l]) found = at;
    }
    offset[l] = (l * (capacity + 2) + found) * row;
  }
}

// Drops the lanes whose list is full and counts the others.
inline std::uint32_t claim_capacity(const Tables& t, Work& w, ListId list, std::uint32_t mask) {
  std::int32_t* count = w.lane_count[static_cast<int>(list)];
  const int capacity = t.capacity[static_cast<int>(list)];
  for (int l = 0; l < kLanes; ++l) {
    if (((mask >> l) & 1u) && count[l] >= capacity) {
      mask &= ~(1u << l);
      w.overflow |= 1u << l;
    }
    count[l] += static_cast<std::int32_t>((mask >> l) & 1u);
  }
  return mask;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
