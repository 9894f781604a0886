// What the general method asks of a shape, handed to its kind. Out of line: many pairs ask, and
// each answer is long.
#include "kernels/collide/convex.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

namespace {

// Calls ask.template operator()<Pose>() for the kind of a shape, tiles among them.
template <class Ask>
MW_INLINE void ask_kind(kernels::ShapeKind kind, Ask&& ask) {
  visit_kind(SpatialShapes{}, kind, ask) || visit_kind(ShapeList<FieldPose>{}, kind, ask);
}

}  // namespace

void load_convex(const Real* hulls, kernels::ShapeKind kind, const Real* base,
                 const std::int32_t* offset, ConvexShape& s) {
  s.kind = kind;
  s.radius = Real(0);
  s.vertices = 0;
  s.margin = Real(1e18);
  visit_kind(SpatialShapes{}, kind, [&]<class Pose>() { Pose::load(hulls, base, offset, s); });
}

Extent extent_along(const ConvexShape& s, Vec3 n, Mask lanes) {
  Extent out{};
  ask_kind(s.kind, [&]<class Pose>() {
    if constexpr (Pose::kKind == kernels::ShapeKind::hull) {
      out = Pose::extent(s, n, lanes);
    } else {
      out = Pose::extent(s, n);
    }
  });
  return out;
}

Vec3 support(const ConvexShape& s, Vec3 n, Mask lanes) {
  Vec3 out{};
  ask_kind(s.kind, [&]<class Pose>() {
    if constexpr (Pose::kKind == kernels::ShapeKind::hull) {
      out = Pose::support(s, n, lanes);
    } else {
      out = Pose::support(s, n);
    }
  });
  return out;
}

void feature_along(const ConvexShape& s, Vec3 n, Real tie, Feature& f) {
  ask_kind(s.kind, [&]<class Pose>() { Pose::feature(s, n, tie, f); });
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
