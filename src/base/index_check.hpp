// Range checks of indices that callers pass, and the text of the error.
#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace manyworlds {

// "joint is -1, must be 0 to 4"
inline std::string wrong_index_text(const std::string& what, std::int64_t index,
                                    std::size_t count) {
  return what + " is " + std::to_string(index) +
         (count == 0 ? ", but there are none" : ", must be 0 to " + std::to_string(count - 1));
}
inline bool is_index(std::int64_t index, std::size_t count) {
  return index >= 0 && static_cast<std::size_t>(index) < count;
}
// Throws std::invalid_argument.
inline void check_index(const char* what, std::int64_t index, std::size_t count) {
  if (!is_index(index, count)) throw std::invalid_argument(wrong_index_text(what, index, count));
}

}  // namespace manyworlds
