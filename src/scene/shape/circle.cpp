// Circles, with their inside.
#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker, detail::kPi;

class CircleTraits final : public TraitsOf<Circle> {
 public:
  CircleTraits() : TraitsOf({.name = "circle", .in_plane = true}) {}

 protected:
  void examine(Checker& checker, const Circle& c) const override {
    checker.size("radius", c.radius);
  }
  MassProperties mass_of(const Circle& c, double density, Space) const override {
    const double r = c.radius, mass = density * kPi * r * r;
    return {mass, Vec3::Zero(), detail::planar_inertia(0.5 * mass * r * r)};
  }
  std::vector<double*> numbers(Circle& c) const override { return {&c.radius}; }
  double reach_of(const Circle& c) const override { return c.radius; }
  std::vector<Convex> parts_of(const Circle& c, const Vec3& x, const Mat3&,
                               Space space) const override {
    return {ball_of(x, c.radius, space)};
  }
  ShapeForm form_of(const Circle& c, const PolygonChoice&) const override {
    ShapeForm f{kernels::ShapeKind::circle};
    f.radius = f.thickness = f.inner_radius = c.radius;
    return f;
  }
  Surface surface_of(const Circle& c, const SurfaceOptions& o) const override {
    Surface out = detail::planar_solid(detail::circle(c.radius, 0, o.around));
    out.marks.push_back({Vec3::Zero(), {c.radius, 0, 0}});
    return out;
  }
};

}  // namespace

MW_GEOMETRY(Circle)

}  // namespace manyworlds
