// Names in the file, for writer and reader.
#pragma once

#include <array>
#include <string>

#include "manyworlds/batch.hpp"

namespace manyworlds::record {

inline constexpr const char* kFormat = "manyworlds recording";

}  // namespace manyworlds::record
