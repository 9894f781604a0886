// What a draw of coordinates (CoordinateDraw) adds to those that a world begins with.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "manyworlds/scene.hpp"
#include "src/base/random.hpp"

namespace manyworlds {

// Beyond those of bodies and of variations (parameters.cpp).
constexpr std::uint64_t kFirstCoordinateDraw = std::uint64_t{1} << 52;

// A standard normal number of two uniform ones (Box, Muller 1958).
inline double normal_of(double u1, double u2) {
  return std::sqrt(-2 * std::log(1 - u1)) * std::cos(2 * std::numbers::pi * u2);
}

// visit(k, number) for the numbers of draw `index` of the scene. Worlds begin within steps: nothing
// is allocated, and what has been drawn is drawn once more instead.
template <class Visit>
void for_each_drawn(const CoordinateDraw& draw, std::size_t index, const Draws& draws,
                    Visit visit) {
  constexpr int kTries = 1000;
  const std::size_t n = draw.low.size();
  std::uint64_t first = kFirstCoordinateDraw + (std::uint64_t{index} << 32);
  const auto drawn = [&](std::size_t k) {
    const std::uint64_t at = first + 2 * k;
    const double low = draw.low[k], high = draw.high[k], u = draws.uniform(at);
    if (!draw.normal) return low + (high - low) * u;
    return (low + high) / 2 + (high - low) / 2 * normal_of(u, draws.uniform(at + 1));
  };
  for (int i = 1; i < kTries; ++i, first += 2 * n) {
    double norm = 0;
    for (std::size_t k = 0; k < n; ++k) norm = std::hypot(norm, drawn(k));
    if (draw.nearest < norm && norm < draw.farthest) break;
  }
  for (std::size_t k = 0; k < n; ++k) visit(k, drawn(k));
}

}  // namespace manyworlds
