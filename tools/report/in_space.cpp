#include "tools/report/in_space.hpp"

#include <cmath>

namespace manyworlds::report {
namespace {

constexpr double kHalfDepth = 0.5;  // m; so that kg/m^2 and kg/m^3 weigh boxes the same

std::optional<Geometry> geometry_in_space(const Geometry& geometry) {
  if (const auto* circle = std::get_if<Circle>(&geometry)) return Sphere{circle->radius};
  if (const auto* half = std::get_if<HalfPlane>(&geometry)) {
    return Plane{Vec3(half->normal.x(), half->normal.y(), 0), half->offset};
  }
  if (std::holds_alternative<Capsule>(geometry)) return geometry;
  if (const auto* polygon = std::get_if<Polygon>(&geometry)) {
    const auto& v = polygon->vertices;
    if (v.size() != 4 || polygon->radius > 0) return std::nullopt;
    const bool box = v[0] == -v[2] && v[1] == -v[3] && v[0].y() == v[1].y() && v[1].x() == v[2].x();
    if (box) return Box{Vec3(v[2].x(), v[2].y(), kHalfDepth)};
  }
  return std::nullopt;
}

}  // namespace

std::optional<Scene> in_space(const Scene& planar) {
  Scene scene = planar;
  scene.space = Space::spatial;
  for (Body& body : scene.bodies) {
    if (body.mass_properties) return std::nullopt;
    for (Shape& shape : body.shapes) {
      const auto geometry = geometry_in_space(shape.geometry);
      if (!geometry) return std::nullopt;
      shape.geometry = *geometry;
    }
  }
  if (!validate(scene).empty()) return std::nullopt;
  return scene;
}

}  // namespace manyworlds::report
