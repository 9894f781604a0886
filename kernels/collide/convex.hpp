// Convex shapes of any kind, as what the general method for pairs of them asks for: how far a shape
// reaches along a direction, which point does, and its faces. Every pair with a cylinder or a hull
// goes through it (collide_convex.cpp), but for closed forms where there are some.
//
// The kind is the same in all lanes, so asking for it is no branch of a lane's.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/shape/poses.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct ConvexShape {
  kernels::ShapeKind kind;
  Vec3 p, half;  // half extents; capsule: half length in z
  Mat3 r;
  Float radius;  // around the core: of spheres and capsules
  Float margin;  // how far its bounds reach beyond it, m; spheres and capsules do not tell
  HullPose hull;
  Vec3 face_normal;  // of a tile
  int vertices;      // of the hull that has most; the other lanes repeat their last
  Vec3 vertex[kernels::kMaxHullVertices];  // from p, world axes
};

struct Extent {
  Float low, high;
};

// `hulls`: where corners are; nullptr: behind the pose row, as those of a fixed shape.
void load_convex(const Real* hulls, kernels::ShapeKind kind, const Real* base,
                 const std::int32_t* offset, ConvexShape& s);

// Reach of the core along a unit direction, from p.
Extent extent_along(const ConvexShape& s, Vec3 n);
// The point of the core that reaches farthest along n, from p.
Vec3 support(const ConvexShape& s, Vec3 n);

// What lies farthest out along n: a face, or an edge or a point of a shape that is round there. A
// lane with fewer points repeats its last.
inline constexpr int kMostCorners = kernels::kMaxHullVertices;
struct Feature {
  int count;
  Vec3 corner[kMostCorners];  // from p, world axes; counter-clockwise seen from outside
  Vec3 normal;                // unit, outward; of a face
  Vec3 along;                 // unit, turns with the body: where the feature's own x axis is
  Float code;
  Mask face;
};
// `tie`: how much better a later face has to be, so that rounding decides nothing.
void feature_along(const ConvexShape& s, Vec3 n, Real tie, Feature& f);

// What convex_axes.cpp finds: a unit normal from A to B, the gap between the cores along it, and a
// point of each core that is nearest there.
struct ConvexAxis {
  Vec3 normal;
  Float separation;
  Vec3 on_a, on_b;  // from A's p
  // The best of the faces' normals: the face's index and whether it is one of B.
  Vec3 face_normal;  // from A to B
  Float face_separation, face;
  Mask face_of_b;
  Mask near;  // elsewhere the bounds' margins do not meet, and nothing else is of use
};
void find_convex_axis(const Tables& t, const ConvexShape& a, const ConvexShape& b, Mask active,
                      ConvexAxis& out);

// The manifold of two convex shapes. B is no sphere, and if one has a radius it is B. `tile`: A, or
// nullptr (tile.hpp).
struct Tile;
void collide_convex_pair(const Tables& t, const ConvexShape& a, const Tile* tile,
                         const ConvexShape& b, Mask active, Manifold<Isotropic, 4>& m);
void collide_plane_convex(const Tables& t, const PlanePose& a, const ConvexShape& b,
                          Manifold<Isotropic, 4>& m);
// B is a sphere.
void collide_convex_sphere(const Tables& t, const ConvexShape& a, const ConvexShape& b, Mask active,
                           Manifold<Isotropic, 1>& m);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
