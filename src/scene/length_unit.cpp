#include "src/scene/length_unit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/scene/shape/shape.hpp"

namespace manyworlds {

double size_of(const Shape& shape, Space space) {
  const double volume = traits_of(shape.geometry).mass_properties(shape.geometry, 1, space).mass;
  return space == Space::planar ? std::sqrt(volume) : std::cbrt(volume);
}

double length_unit_of(const Scene& scene) {
  if (scene.options.length_unit) return *scene.options.length_unit;
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : scene.bodies) {
    if (body.motion != Motion::dynamic) continue;
    for (const Shape& shape : body.shapes) {
      if (shape.filter.mask != 0) least = std::min(least, size_of(shape, scene.space));
    }
  }
  for (const Variation& v : scene.variations) {
    if (v.parameter != Parameter::size) continue;
    for (const double x : v.low) {
      if (x > 0) least = std::min(least, 2 * x);
    }
  }
  return std::isfinite(least) && least > 0 ? least : 1;
}

double slop_of(const Scene& scene) {
  constexpr double kSlop = 0.005;  // of the length unit
  return scene.options.contact.slop.value_or(kSlop * length_unit_of(scene));
}

double checked_unit(const Options& options) {
  return std::max(1.0, options.length_unit.value_or(1));
}

double speed_unit(const Options& options) {
  constexpr double kEarth = 10;  // m/s^2, where there is no gravity to scale by
  const double g = options.gravity.norm();
  return std::sqrt(0.1 * (g > 0 ? g : kEarth) * *options.length_unit);
}

}  // namespace manyworlds
