// Which boxes of the scene bird-sling a bird has knocked out.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <manyworlds/batch.hpp>

namespace birds {

// A box is knocked out when its centre is farther from where the box began than a box is wide, or
// when it has turned by more than 45 degrees and so lies on another side or on an edge.
inline constexpr double kFarthest = 0.8;  // m

// The rows of the bodies that are boxes, by their names.
inline std::vector<int> boxes(const manyworlds::Plan& plan) {
  std::vector<int> out;
  for (int b = 0; b < plan.bodies(); ++b) {
    if (plan.scene().at(plan.body_in_row(b)).name.starts_with("box")) out.push_back(b);
  }
  return out;
}

// Of one world: positions, m, as it began and now, and orientations (cos, sin) now, [body][2].
inline int knocked_out(std::span<const int> boxes, std::span<const double> began,
                       std::span<const double> position, std::span<const double> orientation) {
  int count = 0;
  for (const int box : boxes) {
    const auto x = 2 * static_cast<std::size_t>(box), y = x + 1;
    const double moved = std::hypot(position[x] - began[x], position[y] - began[y]);
    count += moved > kFarthest || orientation[x] < std::sqrt(0.5);
  }
  return count;
}

}  // namespace birds
