// Bytes that came as text.
#pragma once

#include <string>
#include <string_view>

namespace manyworlds::film {

// What is no digit of base64 ends it.
std::string decode_base64(std::string_view text);

}  // namespace manyworlds::film
