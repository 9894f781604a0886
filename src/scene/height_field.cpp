#include "src/scene/height_field.hpp"

#include <algorithm>
#include <cmath>

#include "src/scene/convex.hpp"

namespace manyworlds {

namespace {

// Of a sphere about the shape's frame, m.
double reach_of(const Geometry& geometry) {
  if (const auto* s = std::get_if<Sphere>(&geometry)) return s->radius;
  if (const auto* s = std::get_if<Box>(&geometry)) return s->half_extents.norm();
  if (const auto* s = std::get_if<Capsule>(&geometry)) return s->radius + s->half_length;
  if (const auto* s = std::get_if<Cylinder>(&geometry)) {
    return std::hypot(s->radius, s->half_length);
  }
  double reach = 0;
  if (const auto* s = std::get_if<Hull>(&geometry)) {
    for (const Vec3& v : s->vertices) reach = std::max(reach, v.norm());
  }
  return reach;
}

}  // namespace

double tile_pad(const Options& options) { return 4 * options.slop * options.length_unit; }

TileCount tiles_of(const HeightField& field, const Scene& scene) {
  double reach = 0;
  for (const Body& body : scene.bodies) {
    if (body.motion != Motion::dynamic) continue;
    for (const Shape& shape : body.shapes) reach = std::max(reach, reach_of(shape.geometry));
  }
  // Sizes that vary grow no more than this.
  for (const Variation& v : scene.variations) {
    if (v.parameter == Parameter::size) reach = std::max(reach, 2 * v.high.norm());
  }
  const double span = 2 * (reach + tile_pad(scene.options));
  const auto cells = [&](double cell, int most) {
    const double needed = std::ceil(span / cell) + 2;  // one for rounding
    return static_cast<int>(std::min(needed, static_cast<double>(std::max(most, 1))));
  };
  return {cells(field.cell.x(), field.columns - 1), cells(field.cell.y(), field.rows() - 1)};
}

}  // namespace manyworlds
