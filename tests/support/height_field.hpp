// Height fields of a function, and their surface.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/scenes.hpp"

namespace manyworlds::test {

inline HeightField field_of(int columns, int rows, const Vec2& cell,
                            const std::function<double(double, double)>& height) {
  HeightField out;
  out.columns = columns, out.cell = cell;
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      out.heights.push_back(
          height((i - 0.5 * (columns - 1)) * cell.x(), (j - 0.5 * (rows - 1)) * cell.y()));
    }
  }
  return out;
}
inline double flat(double, double) { return 0; }
inline double hills(double x, double y) {
  return 0.4 * std::sin(1.3 * x) * std::cos(0.9 * y + 0.3 * x);
}

inline Body land(Geometry field, double friction = 0.6) {
  return body_of(shape_of(std::move(field), friction), Vec3::Zero(), Motion::fixed);
}

// The surface below a point, as triangles see it.
inline double surface(const HeightField& f, double x, double y) {
  const double u = x / f.cell.x() + 0.5 * (f.columns - 1),
               v = y / f.cell.y() + 0.5 * (f.rows() - 1);
  const int i = std::min(std::max(static_cast<int>(std::floor(u)), 0), f.columns - 2);
  const int j = std::min(std::max(static_cast<int>(std::floor(v)), 0), f.rows() - 2);
  const auto z = [&](int a, int b) {
    return f.heights[static_cast<std::size_t>(a + b * f.columns)];
  };
  const double s = u - i, t = v - j;
  return s >= t ? z(i, j) + s * (z(i + 1, j) - z(i, j)) + t * (z(i + 1, j + 1) - z(i + 1, j))
                : z(i, j) + t * (z(i, j + 1) - z(i, j)) + s * (z(i + 1, j + 1) - z(i, j + 1));
}

}  // namespace manyworlds::test
