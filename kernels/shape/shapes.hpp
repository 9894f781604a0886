// The shapes that there are, and the way from a kind to its pose. The kind is the same in all
// lanes.
#pragma once

#include "kernels/lane/space.hpp"
#include "kernels/shape/box.hpp"
#include "kernels/shape/capsule.hpp"
#include "kernels/shape/circle.hpp"
#include "kernels/shape/cylinder.hpp"
#include "kernels/shape/ellipsoid.hpp"
#include "kernels/shape/field.hpp"
#include "kernels/shape/hull.hpp"
#include "kernels/shape/link.hpp"
#include "kernels/shape/plane.hpp"
#include "kernels/shape/polygon.hpp"
#include "kernels/shape/rectangle.hpp"
#include "kernels/shape/sphere.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class... Poses>
struct ShapeList {};

// Those that only fixed bodies have stand apart.
using SpatialShapes =
    ShapeList<SpherePose, BoxPose, CapsulePose<Vec3>, CylinderPose, HullPose, EllipsoidPose>;
using SpatialGround = ShapeList<PlanePose, FieldPose>;
using PlanarShapes =
    ShapeList<CirclePose, RectanglePose, CapsulePose<Vec2>, PolygonPose, RoundedPose>;
using PlanarGround = ShapeList<PlanePose, LinkPose>;

template <class Vec>
struct ShapesOf {
  using Moving = SpatialShapes;
  using Ground = SpatialGround;
};
template <>
struct ShapesOf<Vec2> {
  using Moving = PlanarShapes;
  using Ground = PlanarGround;
};

// Calls visit.template operator()<Pose>() for the pose of a kind. Returns whether it is in the
// list.
template <class... Poses, class Visit>
MW_INLINE bool visit_kind(ShapeList<Poses...>, kernels::ShapeKind kind, Visit&& visit) {
  return ((kind == Poses::kKind && (visit.template operator()<Poses>(), true)) || ...);
}

// Calls visit(pose) with the pose in a row. `hulls`: where the corners of hulls are; nullptr:
// behind the row, as those of a fixed shape.
template <class List, class Visit>
MW_INLINE bool visit_pose(List list, kernels::ShapeKind kind, const Real* base,
                          const std::int32_t* o, const Real* hulls, Visit&& visit) {
  return visit_kind(list, kind, [&]<class Pose>() {
    Pose pose;
    if constexpr (requires { load_pose(base, o, hulls, pose); }) {
      load_pose(base, o, hulls, pose);
    } else {
      load_pose(base, o, pose);
    }
    visit(pose);
  });
}

// Writes the pose row of a shape that moves, and returns its bounds.
template <class Placement>
MW_INLINE BoundsOf<typename Placement::Vec> put_shape(const Placement& s) {
  using Vec = typename Placement::Vec;
  BoundsOf<Vec> bounds{};
  visit_kind(typename ShapesOf<Vec>::Moving{}, s.collider.kind,
             [&]<class Pose>() { bounds = Pose::put(s); });
  return bounds;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
