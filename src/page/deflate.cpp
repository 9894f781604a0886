#include "src/page/deflate.hpp"

#include <zlib.h>

#include <limits>
#include <new>
#include <stdexcept>

namespace manyworlds::page {

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes) {
  constexpr int kLevel = 6;  // 9 takes five times as long to save two percent
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::vector<std::uint8_t> out(size);
  const int result =
      compress2(out.data(), &size, bytes.data(), static_cast<uLong>(bytes.size()), kLevel);
  if (result == Z_MEM_ERROR) throw std::bad_alloc();
  if (result != Z_OK) throw std::runtime_error("page: zlib failed with " + std::to_string(result));
  out.resize(size);
  return out;
}

}  // namespace manyworlds::page
