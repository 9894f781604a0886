#include "manyworlds/nearest.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

namespace manyworlds {

// Levenshtein's. `row` holds the distances of the prefixes of b from the current prefix of a.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const std::size_t substitution = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = row[j + 1];
      row[j + 1] = std::min({substitution, row[j] + 1, diagonal + 1});
    }
  }
  return row[b.size()];
}

std::optional<std::string> nearest(std::string_view word, std::span<const std::string> known) {
  std::optional<std::string> best;
  std::size_t fewest = 0;
  for (const std::string& one : known) {
    const std::size_t edits = edit_distance(word, one);
    if (edits > std::max<std::size_t>(1, std::max(word.size(), one.size()) / 3)) continue;
    if (best && edits >= fewest) continue;
    best = one;
    fewest = edits;
  }
  return best;
}

}  // namespace manyworlds
