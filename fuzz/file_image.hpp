// HDF5 files in memory that can be changed, and got back.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "src/record/h5.hpp"

namespace manyworlds::fuzz {

// Opens a copy of the bytes for reading and writing; no file is touched. One at a time.
record::Handle open_image(std::span<const std::byte> bytes);
// What the last one was when all handles of it had been closed.
std::vector<std::byte> take_closed_image();

}  // namespace manyworlds::fuzz
