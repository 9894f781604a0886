// Spheres.
#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker, detail::kPi;

class SphereTraits final : public TraitsOf<Sphere> {
 public:
  SphereTraits() : TraitsOf({.name = "sphere", .in_space = true}) {}

 protected:
  void examine(Checker& checker, const Sphere& s) const override {
    checker.size("radius", s.radius);
  }
  MassProperties mass_of(const Sphere& s, double density, Space) const override {
    const double r = s.radius, mass = density * 4.0 / 3.0 * kPi * r * r * r;
    return {mass, Vec3::Zero(), 0.4 * mass * r * r * Mat3::Identity()};
  }
  std::vector<double*> numbers(Sphere& s) const override { return {&s.radius}; }
  double reach_of(const Sphere& s) const override { return s.radius; }
  std::vector<Convex> parts_of(const Sphere& s, const Vec3& x, const Mat3&,
                               Space space) const override {
    return {ball_of(x, s.radius, space)};
  }
  ShapeForm form_of(const Sphere& s, const PolygonChoice&) const override {
    ShapeForm f{kernels::ShapeKind::sphere};
    f.radius = f.thickness = f.inner_radius = s.radius;
    return f;
  }
  Surface surface_of(const Sphere& s, const SurfaceOptions& o) const override {
    return detail::ball(s.radius, o.around);
  }
};

}  // namespace

MW_GEOMETRY(Sphere)

}  // namespace manyworlds
