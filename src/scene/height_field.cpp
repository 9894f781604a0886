#include "src/scene/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "src/scene/length_unit.hpp"
#include "src/scene/shape/shape.hpp"

namespace manyworlds {

double tile_pad(const Scene& scene) { return 4 * slop_of(scene); }

TileCount tiles_of(const HeightField& field, const Scene& scene) {
  double reach = 0;
  for (const Body& body : scene.bodies) {
    if (body.motion != Motion::dynamic) continue;
    for (const Shape& shape : body.shapes) {
      reach = std::max(reach, traits_of(shape.geometry).reach(shape.geometry));
    }
  }
  // Sizes that vary grow no more than this.
  for (const Variation& v : scene.variations) {
    if (v.parameter == Parameter::size) reach = std::max(reach, 2 * v.high.norm());
  }
  const double span = 2 * (reach + tile_pad(scene));
  const auto cells = [&](double cell, int most) {
    const double needed = std::ceil(span / cell) + 2;  // one for rounding
    return static_cast<int>(std::min(needed, static_cast<double>(std::max(most, 1))));
  };
  return {cells(field.cell.x(), field.columns - 1), cells(field.cell.y(), field.rows() - 1)};
}

}  // namespace manyworlds
