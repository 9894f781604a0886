// Ellipsoids.
#include <cmath>

#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker, detail::kPi;

class EllipsoidTraits final : public TraitsOf<Ellipsoid> {
 public:
  EllipsoidTraits() : TraitsOf({.name = "ellipsoid", .in_space = true}) {}

 protected:
  void examine(Checker& checker, const Ellipsoid& e) const override {
    checker.size("radii.x", e.radii.x());
    checker.size("radii.y", e.radii.y());
    checker.size("radii.z", e.radii.z());
  }
  MassProperties mass_of(const Ellipsoid& e, double density, Space) const override {
    const Vec3 squares = e.radii.cwiseAbs2();
    const double mass = density * 4.0 / 3.0 * kPi * e.radii.prod();
    const Vec3 moments = mass / 5.0 * (Vec3::Constant(squares.sum()) - squares);
    return {mass, Vec3::Zero(), moments.asDiagonal()};
  }
  std::vector<double*> numbers(Ellipsoid& e) const override {
    double* radii = e.radii.data();
    return {radii, radii + 1, radii + 2};
  }
  double reach_of(const Ellipsoid& e) const override { return e.radii.maxCoeff(); }
  std::vector<Convex> parts_of(const Ellipsoid& e, const Vec3& x, const Mat3& r,
                               Space) const override {
    Convex part;
    part.points = {x};
    part.axes = r;
    part.radii = e.radii;
    for (int k = 0; k < 3; ++k) part.normals.push_back(r.col(k));
    return {part};
  }
  ShapeForm form_of(const Ellipsoid& e, const PolygonChoice&) const override {
    ShapeForm f{kernels::ShapeKind::ellipsoid};
    f.half = e.radii;
    f.radius = e.radii.maxCoeff();
    f.inner_radius = e.radii.minCoeff();
    return f;
  }
  Outline outline_of(const Ellipsoid& e, Space) const override {
    constexpr int kRings = 5, kAround = 12;
    Outline out{{Vec3(0, 0, -e.radii.z()), Vec3(0, 0, e.radii.z())}, 0};
    for (int i = 1; i <= kRings; ++i) {
      const double polar = kPi * i / (kRings + 1);
      for (int k = 0; k < kAround; ++k) {
        const double angle = 2 * kPi * k / kAround;
        const Vec3 unit(std::sin(polar) * std::cos(angle), std::sin(polar) * std::sin(angle),
                        std::cos(polar));
        out.points.push_back(unit.cwiseProduct(e.radii));
      }
    }
    return out;
  }
};

}  // namespace

MW_GEOMETRY(Ellipsoid)

}  // namespace manyworlds
