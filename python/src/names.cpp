#include "names.hpp"

#include "manyworlds/nearest.hpp"

namespace manyworlds::python {

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
