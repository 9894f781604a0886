// Compressed bytes as text.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "src/page/base64.hpp"

namespace manyworlds::page {

// In the format of zlib, which browsers call "deflate". Throws std::runtime_error.
std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes);
inline std::string packed(std::span<const std::uint8_t> bytes) { return base64(deflated(bytes)); }

}  // namespace manyworlds::page
