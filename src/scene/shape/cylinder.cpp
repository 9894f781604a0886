// Cylinders about z.
#include <algorithm>
#include <cmath>

#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker, detail::kPi;

class CylinderTraits final : public TraitsOf<Cylinder> {
 public:
  CylinderTraits() : TraitsOf({.name = "cylinder", .in_space = true}) {}

 protected:
  void examine(Checker& checker, const Cylinder& c) const override {
    checker.size("radius", c.radius);
    checker.size("half_length", c.half_length);
  }
  MassProperties mass_of(const Cylinder& c, double density, Space) const override {
    const double r = c.radius, h = c.half_length;
    const double mass = density * 2 * kPi * r * r * h;
    const double across = mass * (r * r / 4 + h * h / 3);
    return {mass, Vec3::Zero(), Vec3(across, across, mass * r * r / 2).asDiagonal()};
  }
  std::vector<double*> numbers(Cylinder& c) const override { return {&c.radius, &c.half_length}; }
  double reach_of(const Cylinder& c) const override { return std::hypot(c.radius, c.half_length); }
  std::vector<Convex> parts_of(const Cylinder& c, const Vec3& x, const Mat3& r,
                               Space space) const override {
    const Vec3 end = r.col(2) * c.half_length;
    Convex part = segment_of(x - end, x + end, 0, space);
    part.axes = r;
    part.radii = {c.radius, c.radius, 0};
    return {part};
  }
  ShapeForm form_of(const Cylinder& c, const PolygonChoice&) const override {
    ShapeForm f{kernels::ShapeKind::cylinder};
    f.half = {c.radius, c.radius, c.half_length};
    f.radius = std::hypot(c.radius, c.half_length);
    f.inner_radius = std::min(c.radius, c.half_length);
    return f;
  }
  Surface surface_of(const Cylinder& c, const SurfaceOptions& o) const override {
    Surface out;
    detail::add_revolved(out, {{c.radius, -c.half_length, 1, 0}, {c.radius, c.half_length, 1, 0}},
                         o.around);
    for (const double end : {-1.0, 1.0}) {
      std::vector<Vec3> rim = detail::circle(c.radius, end * c.half_length, o.around);
      out.lines.push_back(detail::closed(rim));
      if (end < 0) std::reverse(rim.begin(), rim.end());
      detail::add_face(out, rim, end * Vec3::UnitZ());
    }
    out.marks.push_back({{c.radius, 0, -c.half_length}, {c.radius, 0, c.half_length}});
    return out;
  }
};

}  // namespace

MW_GEOMETRY(Cylinder)

}  // namespace manyworlds
