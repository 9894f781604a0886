#include "names.hpp"

#include <numeric>

namespace manyworlds::python {

int edit_distance(std::string_view a, std::string_view b) {
  std::vector<int> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 0; i < a.size(); ++i) {
    int corner = row[0];
    row[0] = static_cast<int>(i) + 1;
    for (std::size_t j = 0; j < b.size(); ++j) {
      const int changed = corner + (a[i] == b[j] ? 0 : 1);
      corner = row[j + 1];
      row[j + 1] = std::min({changed, corner + 1, row[j] + 1});
    }
  }
  return row.back();
}

std::string unknown_name(std::string_view found, const std::vector<std::string>& known) {
  std::string text = "is '" + std::string(found) + "'; expected one of ";
  const auto nearest =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) {
        return edit_distance(found, a) < edit_distance(found, b);
      });
  for (std::size_t i = 0; i < known.size(); ++i) text += (i > 0 ? ", '" : "'") + known[i] + "'";
  return nearest == known.end() ? text : text + " (nearest: '" + *nearest + "')";
}

}  // namespace manyworlds::python
