// The known word closest to an unknown one, for error texts.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "manyworlds/require_cxx20.hpp"

namespace manyworlds {

// Edits (insert, remove or change a letter) that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b);
// The one with the fewest edits from `word`, the first of those; nothing if none is near: if each
// takes more than a third of its letters, and more than one.
std::optional<std::string> nearest(std::string_view word, std::span<const std::string> known);

}  // namespace manyworlds
