// The first 512 bytes of a recording, which HDF5 leaves to its users: the writer, the length,
// and a checksum of all of it. So nothing is given to HDF5 that was cut or damaged on the way:
//   magic (8) | format version (4) | 0 (4) | size of the file (8) | checksum (8) | 0 ...
// little endian; the checksum is Hasher's over the words of the file, with 0 in its own place.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

#include "src/base/output_file.hpp"

namespace manyworlds::record {

inline constexpr std::int32_t kFormatVersion = 2;
inline constexpr std::size_t kFrameSize = 512;
inline constexpr const char* kFrameMagic = "MWRECO\r\n";

// Fills in the block of a finished file. Throws FileError.
void seal(OutputFile& file, std::uint64_t size);
void seal(std::span<std::byte> bytes);
// Throw RecordError unless the block is there and right.
void check_frame(const std::filesystem::path& file);
void check_frame(std::span<const std::byte> bytes);

}  // namespace manyworlds::record
