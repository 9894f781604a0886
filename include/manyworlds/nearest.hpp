// The known word closest to an unknown one, for error messages.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// Number of edits (insert, remove or change a letter) from one word to the other.
std::size_t edit_distance(std::string_view a, std::string_view b);
// The known word with the fewest edits from `word`; the first of several. Empty if every word needs
// more than one edit and more than a third of its letters.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string> known);

}  // namespace manyworlds
