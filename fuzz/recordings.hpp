// The valid recordings that fuzzing changes.
#pragma once

#include <cstddef>
#include <vector>

namespace manyworlds::fuzz {

inline constexpr int kRecordings = 5;

// Planar and spatial, of one kind of world and of several, with sleep, with numbers that vary from
// world to world, and with inputs of every sort. Made when first asked for.
const std::vector<std::byte>& recording(int index);

}  // namespace manyworlds::fuzz
