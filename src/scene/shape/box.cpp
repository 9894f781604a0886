// Boxes.
#include "src/scene/shape/traits.hpp"

namespace manyworlds {
namespace {

using detail::Checker;

class BoxTraits final : public TraitsOf<Box> {
 public:
  BoxTraits() : TraitsOf({.name = "box", .in_space = true}) {}

 protected:
  void examine(Checker& checker, const Box& b) const override {
    checker.size("half_extents.x", b.half_extents.x());
    checker.size("half_extents.y", b.half_extents.y());
    checker.size("half_extents.z", b.half_extents.z());
  }
  MassProperties mass_of(const Box& b, double density, Space) const override {
    const Vec3 squares = b.half_extents.cwiseAbs2();
    const double mass = density * 8 * b.half_extents.prod();
    const Vec3 moments = mass / 3.0 * (Vec3::Constant(squares.sum()) - squares);
    return {mass, Vec3::Zero(), moments.asDiagonal()};
  }
  std::vector<double*> numbers(Box& b) const override {
    double* half = b.half_extents.data();
    return {half, half + 1, half + 2};
  }
  double reach_of(const Box& b) const override { return b.half_extents.norm(); }
  std::vector<Convex> parts_of(const Box& b, const Vec3& x, const Mat3& r, Space) const override {
    Convex c;
    c.axes = r, c.center = x, c.half = b.half_extents;
    for (int i = 0; i < 8; ++i) {
      c.points.push_back(x + r * corner(b, i));
      for (const int bit : {1, 2, 4}) {
        if (!(i & bit)) c.edges.push_back({i, i | bit});
      }
    }
    for (int k = 0; k < 3; ++k) c.normals.push_back(r.col(k));
    c.directions = c.normals;
    return {c};
  }
  ShapeForm form_of(const Box& b, const PolygonChoice&) const override {
    ShapeForm f{kernels::ShapeKind::box};
    f.half = b.half_extents;
    f.radius = f.half.norm();
    f.inner_radius = f.half.minCoeff();
    return f;
  }
  Surface surface_of(const Box& b, const SurfaceOptions&) const override {
    Surface out;
    for (int axis = 0; axis < 3; ++axis) {
      for (const double side : {-1.0, 1.0}) {
        const Vec3 normal = side * Vec3::Unit(axis);
        const Vec3 u = Vec3::Unit((axis + 1) % 3), v = side * Vec3::Unit((axis + 2) % 3);
        std::vector<Vec3> corners;
        for (const Vec3& sign : {Vec3(-u - v), Vec3(u - v), Vec3(u + v), Vec3(v - u)}) {
          corners.push_back((normal + sign).cwiseProduct(b.half_extents));
        }
        detail::add_face(out, corners, normal);
        if (axis == 2) out.lines.push_back(detail::closed(corners));
      }
    }
    for (const int i : {0, 1, 2, 3}) out.lines.push_back({corner(b, i), corner(b, i | 4)});
    return out;
  }

 private:
  static Vec3 corner(const Box& b, int i) {
    const Vec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
    return sign.cwiseProduct(b.half_extents);
  }
};

}  // namespace

MW_GEOMETRY(Box)

}  // namespace manyworlds
