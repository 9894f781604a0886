// Checks of one shape: whether its geometry belongs there, local pose, density, material.
#include <string>
#include <string_view>

#include "src/scene/shape/traits.hpp"

namespace manyworlds::detail {
namespace {

void check_kind(Checker& checker, const Body& body, const GeometryTraits& kind) {
  const bool vowel = std::string_view("aeiou").find(kind.name[0]) != std::string_view::npos;
  const std::string found = std::string(vowel ? "is an " : "is a ") + kind.name;
  if (!(checker.planar() ? kind.in_plane : kind.in_space)) {
    checker.add("geometry", found + ", a " + (checker.planar() ? "planar" : "spatial") +
                                " scene takes " + geometry_names(checker.space()));
  }
  if (kind.ground && body.motion != Motion::fixed) {
    checker.add("geometry", found + " on a body that can move, must be on a fixed body");
  }
}

}  // namespace

void check_shape(Checker checker, const Body& body, const Shape& shape) {
  const GeometryTraits& kind = traits_of(shape.geometry);
  check_kind(checker, body, kind);
  kind.check(checker, shape.geometry);

  if (checker.finite("position", shape.position, "m")) {
    check_point(checker, "position", shape.position);
  }
  checker.rotation("rotation", shape.rotation);
  if (shape.density) checker.density("density", *shape.density);
  checker.not_negative("material.friction", shape.material.friction, "");
  check_soft_contact(checker, shape.material.soft);
  checker.between("material.restitution", shape.material.restitution, 0, 1);
  checker.not_negative("material.rolling_resistance", shape.material.rolling_resistance, "m");
  const double torsional = shape.material.torsional_resistance;
  checker.not_negative("material.torsional_resistance", torsional, "m");
  if (checker.planar() && torsional > 0) {
    checker.add(
        "material.torsional_resistance",
        "is " + number_text(torsional) + ", must be 0: nothing spins about a normal in the plane");
  }
}

}  // namespace manyworlds::detail
