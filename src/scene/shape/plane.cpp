// Planes and half-planes.
#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker;

class PlaneTraits final : public TraitsOf<Plane> {
 public:
  PlaneTraits() : TraitsOf({.name = "plane", .in_space = true, .ground = true}) {}

 protected:
  void examine(Checker& checker, const Plane& plane) const override {
    bool good = checker.finite("normal.x", plane.normal.x(), "");
    good &= checker.finite("normal.y", plane.normal.y(), "");
    good &= checker.finite("normal.z", plane.normal.z(), "");
    if (good) detail::check_unit(checker, "normal", plane.normal.norm());
    detail::check_coordinate(checker, "offset", plane.offset);
  }
  std::vector<Convex> parts_of(const Plane& plane, const Vec3& x, const Mat3& r,
                               Space) const override {
    return {half_space_of(plane.normal, plane.offset, x, r)};
  }
};

class HalfPlaneTraits final : public TraitsOf<HalfPlane> {
 public:
  HalfPlaneTraits() : TraitsOf({.name = "half-plane", .in_plane = true, .ground = true}) {}

 protected:
  void examine(Checker& checker, const HalfPlane& plane) const override {
    bool good = checker.finite("normal.x", plane.normal.x(), "");
    good &= checker.finite("normal.y", plane.normal.y(), "");
    if (good) detail::check_unit(checker, "normal", plane.normal.norm());
    detail::check_coordinate(checker, "offset", plane.offset);
  }
  std::vector<Convex> parts_of(const HalfPlane& plane, const Vec3& x, const Mat3& r,
                               Space) const override {
    return {half_space_of(detail::in_plane(plane.normal), plane.offset, x, r)};
  }
};

}  // namespace

MW_GEOMETRY(Plane)
MW_GEOMETRY(HalfPlane)

}  // namespace manyworlds
