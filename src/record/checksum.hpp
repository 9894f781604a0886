// The checksum of files: Hasher's, over their words, little endian.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "src/base/hash.hpp"

namespace manyworlds::record {

// In pieces whose sizes are multiples of 8, but for the last.
class Checksum {
 public:
  void add(std::span<const std::byte> bytes) {
    std::size_t at = 0;
    for (; at + sizeof(std::uint64_t) <= bytes.size(); at += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, bytes.data() + at, sizeof word);
      hasher_.add(word);
    }
    for (; at < bytes.size(); ++at) hasher_.add(static_cast<std::uint64_t>(bytes[at]));
  }
  std::uint64_t value() const { return hasher_.value(); }

 private:
  Hasher hasher_;
};

}  // namespace manyworlds::record
