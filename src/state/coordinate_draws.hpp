// What a draw of coordinates (CoordinateDraw) adds to those that a world begins with.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "manyworlds/scene.hpp"
#include "src/base/random.hpp"

namespace manyworlds {

// Beyond those of bodies and of variations (parameters.cpp).
constexpr std::uint64_t kFirstCoordinateDraw = std::uint64_t{1} << 52;

// A standard normal number of two uniform ones (Box, Muller 1958).
inline double normal_of(double u1, double u2) {
  return std::sqrt(-2 * std::log(1 - u1)) * std::cos(2 * std::numbers::pi * u2);
}

// The numbers of draw `index` of the scene.
inline std::vector<double> drawn_coordinates(const CoordinateDraw& draw, std::size_t index,
                                             const Draws& draws) {
  constexpr int kTries = 1000;
  const std::size_t n = draw.low.size();
  std::vector<double> out(n);
  std::uint64_t next = kFirstCoordinateDraw + (std::uint64_t{index} << 32);
  for (int i = 0; i < kTries; ++i) {
    double norm = 0;
    for (std::size_t k = 0; k < n; ++k, next += 2) {
      const double low = draw.low[k], high = draw.high[k], u = draws.uniform(next);
      out[k] = draw.normal
                   ? (low + high) / 2 + (high - low) / 2 * normal_of(u, draws.uniform(next + 1))
                   : low + (high - low) * u;
      norm = std::hypot(norm, out[k]);
    }
    if (draw.nearest < norm && norm < draw.farthest) break;
  }
  return out;
}

}  // namespace manyworlds
