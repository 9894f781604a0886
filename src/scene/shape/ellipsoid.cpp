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
  Surface surface_of(const Ellipsoid& e, const SurfaceOptions& o) const override {
    Surface out = detail::ball(1, o.around);
    // A plane's normal is stretched by the inverse of what stretches the plane.
    for (Vec3& p : out.points) p = p.cwiseProduct(e.radii);
    for (Vec3& n : out.normals) n = n.cwiseQuotient(e.radii).normalized();
    for (auto& line : out.marks) {
      for (Vec3& p : line) p = p.cwiseProduct(e.radii);
    }
    return out;
  }
};

}  // namespace

MW_GEOMETRY(Ellipsoid)

}  // namespace manyworlds
