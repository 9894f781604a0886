// Capsules, in the plane and in space.
#include <cmath>

#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker, detail::kPi;

// A cylinder and two half balls, whose centres of mass are 3/8 r beyond its ends: about the middle,
// across the axis, a pair of them of mass m has m (2/5 r^2 + h^2 + 3/4 h r).
MassProperties spatial_mass(const Capsule& capsule, double density) {
  const double r = capsule.radius, h = capsule.half_length;
  const double cylinder = density * 2 * kPi * r * r * h;
  const double ends = density * 4.0 / 3.0 * kPi * r * r * r;
  const double along = cylinder * r * r / 2 + ends * 0.4 * r * r;
  const double across =
      cylinder * (r * r / 4 + h * h / 3) + ends * (0.4 * r * r + h * h + 0.75 * h * r);
  return {cylinder + ends, Vec3::Zero(), Vec3(across, across, along).asDiagonal()};
}

// A rectangle and two half discs, whose centres of mass are 4 r / (3 pi) beyond its ends.
MassProperties planar_mass(const Capsule& capsule, double density) {
  const double r = capsule.radius, h = capsule.half_length;
  const double rectangle = density * 4 * r * h;
  const double ends = density * kPi * r * r;
  const double moment =
      rectangle * (r * r + h * h) / 3 + ends * (r * r / 2 + h * h + 8 * r * h / (3 * kPi));
  return {rectangle + ends, Vec3::Zero(), detail::planar_inertia(moment)};
}

class CapsuleTraits final : public TraitsOf<Capsule> {
 public:
  CapsuleTraits() : TraitsOf({.name = "capsule", .in_plane = true, .in_space = true}) {}

 protected:
  void examine(Checker& checker, const Capsule& c) const override {
    checker.size("radius", c.radius);
    checker.size("half_length", c.half_length);
  }
  MassProperties mass_of(const Capsule& c, double density, Space space) const override {
    return space == Space::planar ? planar_mass(c, density) : spatial_mass(c, density);
  }
  std::vector<double*> numbers(Capsule& c) const override { return {&c.radius, &c.half_length}; }
  double reach_of(const Capsule& c) const override { return c.radius + c.half_length; }
  std::vector<Convex> parts_of(const Capsule& c, const Vec3& x, const Mat3& r,
                               Space space) const override {
    const Vec3 end = r * end_of(c, space);
    return {segment_of(x - end, x + end, c.radius, space)};
  }
  ShapeForm form_of(const Capsule& c, const PolygonChoice&) const override {
    ShapeForm f{kernels::ShapeKind::capsule};
    f.half.x() = c.half_length;
    f.thickness = f.inner_radius = c.radius;
    f.radius = c.half_length + c.radius;
    return f;
  }
  Surface surface_of(const Capsule& c, const SurfaceOptions& o) const override {
    const double r = c.radius, h = c.half_length;
    if (o.space == Space::planar) {
      std::vector<Vec3> outline;
      detail::add_arc(outline, {0, h, 0}, r, 0, kPi, o.around);
      detail::add_arc(outline, {0, -h, 0}, r, kPi, 2 * kPi, o.around);
      return detail::planar_solid(outline);
    }
    Surface out;
    std::vector<detail::Ring> rings;
    const int quarter = (o.around + 3) / 4;
    for (const double end : {-1.0, 1.0}) {
      for (int i = 0; i <= quarter; ++i) {
        const double a = end < 0 ? kPi / 2 * (quarter - i) / quarter : kPi / 2 * i / quarter;
        const bool pole = i == (end < 0 ? 0 : quarter);
        const double c_a = pole ? 0 : std::cos(a), s_a = end * std::sin(a);
        rings.push_back({r * c_a, end * h + r * s_a, c_a, s_a});
      }
    }
    detail::add_revolved(out, rings, o.around);
    for (const double end : {-h, h}) {
      out.lines.push_back(detail::closed(detail::circle(r, end, o.around)));
    }
    out.marks.push_back({{r, 0, -h}, {r, 0, h}});
    return out;
  }

 private:
  static Vec3 end_of(const Capsule& c, Space space) {
    return c.half_length * (space == Space::planar ? Vec3::UnitY() : Vec3::UnitZ());
  }
};

}  // namespace

MW_GEOMETRY(Capsule)

}  // namespace manyworlds
