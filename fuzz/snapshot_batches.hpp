// The batches that snapshots are restored into, and how to give bytes a right frame.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::fuzz {

inline constexpr int kBatches = 4;
inline constexpr int kWorlds = 3;

// Planar and spatial, every contact list, with and without sleep and disabled bodies.
Batch make_batch(int index);

// Makes magic, version, sizes and checksum right, so that what lies within is looked at. Leaves
// alone what is too short for a header.
void frame(std::vector<std::byte>& bytes);

}  // namespace manyworlds::fuzz
