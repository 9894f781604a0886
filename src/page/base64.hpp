// Bytes as text, and back (RFC 4648).
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace manyworlds::page {

std::string base64(std::span<const std::uint8_t> bytes);

// What is no digit of base64 ends it.
std::string from_base64(std::string_view text);

}  // namespace manyworlds::page
