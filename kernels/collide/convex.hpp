// The general method for pairs of convex shapes in space. It asks a shape how far it reaches along
// a direction, which point does, and for its faces (shape/convex_shape.hpp). Every pair with a
// cylinder or a hull goes through it, but for closed forms where there are some.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/shape/shapes.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// `hulls`: where tables of hulls are; nullptr: behind the pose row, as those of a fixed shape.
void load_convex(const Real* hulls, kernels::ShapeKind kind, const Real* base,
                 const std::int32_t* offset, ConvexShape& s);

// Reach of the core along a unit direction, from p. `lanes`: where the answer counts.
Extent extent_along(const ConvexShape& s, Vec3 n, Mask lanes);
// The point of the core that reaches farthest along n, from p.
Vec3 support(const ConvexShape& s, Vec3 n, Mask lanes);

// What lies farthest out along n.
// `tie`: how much better a later face has to be, so that rounding decides nothing.
void feature_along(const ConvexShape& s, Vec3 n, Real tie, Feature& f);

// What convex_axes.cpp and hull_axes.cpp find: a unit normal from A to B, the gap between the cores
// along it, and a point of each core that is nearest there.
struct ConvexAxis {
  Vec3 normal;
  Float separation;
  Vec3 on_a, on_b;  // from A's p
  Mask touch;       // lanes in which they touch there: not beside a tile (collide_convex.cpp)
  // The best of the faces' normals, of hulls of those that look along the normal, and whether it is
  // one of B.
  Vec3 face_normal;  // from A to B
  Float face_separation;
  Mask face_of_b;
  Mask near;  // elsewhere the bounds' margins do not meet, and nothing else is of use
};
void find_convex_axis(const Constants& t, const ConvexShape& a, const ConvexShape& b, Mask active,
                      ConvexAxis& out);

// The manifold of two convex shapes. B is no sphere, and if one has a radius it is B. `tile`: A, or
// nullptr (tile.hpp).
struct Tile;
void collide_convex_pair(const Constants& t, const ConvexShape& a, const Tile* tile,
                         const ConvexShape& b, Mask active, Manifold<Isotropic, 4>& m);
void collide_plane_convex(const Constants& t, const PlanePose& a, const ConvexShape& b,
                          Manifold<Isotropic, 4>& m);
// Of pairs that touch at one point: B is a sphere, or one of the two is round all over. `tile`: A,
// or nullptr; then B is no sphere.
void collide_convex_point(const Constants& t, const ConvexShape& a, const Tile* tile,
                          const ConvexShape& b, Mask active, Manifold<Isotropic, 1>& m);
void collide_plane_point(const PlanePose& a, const ConvexShape& b, Manifold<Isotropic, 1>& m);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
