// Single bits of a word.
#pragma once

#include <cstddef>
#include <cstdint>

namespace manyworlds {

// Lanes of a group are chosen by the bits of a word.
inline constexpr std::size_t kMaxLanes = 32;

inline constexpr bool get_bit(std::uint32_t word, std::size_t at) {
  return ((word >> at) & 1u) != 0;
}
inline constexpr void put_bit(std::uint32_t& word, std::size_t at, bool value) {
  word = (word & ~(1u << at)) | (static_cast<std::uint32_t>(value) << at);
}

}  // namespace manyworlds
