// Planes and half-planes.
#include <algorithm>
#include <cmath>

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
  Surface surface_of(const Plane& plane, const SurfaceOptions& o) const override {
    const Vec3 n = plane.normal.normalized();
    const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
    // Around the foot of the box's middle, and beyond the box on all sides.
    const Vec3 middle = (o.low + o.high) / 2;
    const Vec3 foot = middle + (plane.offset - n.dot(middle)) * n;
    const double far = (o.high - o.low).norm() + (foot - middle).norm();
    std::vector<Vec3> corners = {foot - far * u - far * v, foot + far * u - far * v,
                                 foot + far * u + far * v, foot - far * u + far * v};
    for (int axis = 0; axis < 3; ++axis) {
      corners = detail::clipped(corners, Vec3::Unit(axis), o.high[axis]);
      corners = detail::clipped(corners, -Vec3::Unit(axis), -o.low[axis]);
    }
    Surface out;
    if (corners.size() < 3) return out;
    detail::add_face(out, corners, n);
    out.lines.push_back(detail::closed(std::move(corners)));
    return out;
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
  Surface surface_of(const HalfPlane& plane, const SurfaceOptions& o) const override {
    const Vec3 n = detail::in_plane(plane.normal.normalized()), along(-n.y(), n.x(), 0);
    const std::vector<Vec3> box = {{o.low.x(), o.low.y(), 0},
                                   {o.high.x(), o.low.y(), 0},
                                   {o.high.x(), o.high.y(), 0},
                                   {o.low.x(), o.high.y(), 0}};
    Surface out;
    detail::add_face(out, detail::clipped(box, n, plane.offset), Vec3::UnitZ());
    // Of the box, the points on the surface that are farthest to either side.
    const std::vector<Vec3> above = detail::clipped(box, -n, -plane.offset);
    std::vector<Vec3> line;
    const double near = 1e-9 * (o.high - o.low).norm();
    for (const Vec3& p : above) {
      if (std::abs(n.dot(p) - plane.offset) <= near) line.push_back(p);
    }
    std::sort(line.begin(), line.end(),
              [&](const Vec3& a, const Vec3& b) { return along.dot(a) > along.dot(b); });
    if (line.size() > 1) out.lines.push_back({line.front(), line.back()});
    return out;
  }
};

}  // namespace

MW_GEOMETRY(Plane)
MW_GEOMETRY(HalfPlane)

}  // namespace manyworlds
