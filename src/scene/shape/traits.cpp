#include "src/scene/shape/traits.hpp"

#include <cmath>
#include <utility>

namespace manyworlds {

const GeometryTraits& traits_of(const Geometry& geometry) {
  const auto find = []<class G>(const G&) -> const GeometryTraits& { return traits_of<G>(); };
  return std::visit(find, geometry);
}

std::string geometry_names(Space space) {
  std::vector<std::string> moving, ground;
  const auto take = [&](const GeometryTraits& t) {
    const bool there = space == Space::planar ? t.in_plane : t.in_space;
    if (there) (t.ground ? ground : moving).push_back(t.name);
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (take(traits_of<std::variant_alternative_t<I, Geometry>>()), ...);
  }
  (std::make_index_sequence<std::variant_size_v<Geometry>>());
  moving.insert(moving.end(), ground.begin(), ground.end());
  std::string out;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    out += (i == 0 ? "" : i + 1 == moving.size() ? " and " : ", ") + moving[i];
  }
  return out;
}

namespace detail {

bool check_coordinate(Checker& checker, std::string_view field, double value) {
  if (std::abs(value) <= kLargestSize) return true;
  if (!std::isfinite(value)) return checker.finite(field, value, "m");
  checker.add(field, "is " + number_text(value) + " m, must be between " +
                         number_text(-kLargestSize) + " and " + number_text(kLargestSize));
  return false;
}
bool check_point(Checker& checker, const std::string& field, const Vec2& point) {
  const bool good = check_coordinate(checker, field + ".x", point.x());
  return check_coordinate(checker, field + ".y", point.y()) && good;
}
bool check_point(Checker& checker, const std::string& field, const Vec3& point) {
  const bool good = check_point(checker, field, Vec2(point.head<2>()));
  return check_coordinate(checker, field + ".z", point.z()) && good;
}
void check_unit(Checker& checker, std::string_view field, double length) {
  if (std::abs(length - 1) <= kInputTolerance) return;
  checker.add(field, "has length " + number_text(length) + ", must be 1 (within " +
                         number_text(kInputTolerance) + ")");
}

}  // namespace detail
}  // namespace manyworlds
