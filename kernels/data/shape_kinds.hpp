// Kinds of shapes, and what follows from a kind alone.
#pragma once

#include "kernels/data/pose_rows.hpp"

namespace manyworlds::kernels {

enum class ShapeKind : int {
  sphere,
  box,
  circle,
  rectangle,
  polygon,
  plane,
  capsule,
  link,  // of a terrain
  cylinder,
  hull,
  rounded,  // polygon
  tile,     // of a height field
  ellipsoid,
};
inline constexpr int kShapeKinds = 13;

struct ShapeInfo {
  const char* name;
  // Of two shapes that move the one of higher rank is A of their pair. A fixed shape is A whatever
  // it is.
  int rank;
  int row;               // numbers of its pose row, before those that follow it
  int margin = -1;       // number of its row that is the margin of its bounds, m; -1: none
  bool planar = false;   // it exists in the plane alone
  bool ground = false;   // only fixed bodies have it
  bool ball = false;     // a ball about its origin
  bool single = false;   // it touches anything at one point at most
  bool general = false;  // all its pairs go by the general convex method (collide/convex.hpp)
};

inline constexpr int kBoxMargin = offsetof(BoxRow<float>, margin) / sizeof(float);
static_assert(kBoxMargin == offsetof(TileRow<float>, margin) / sizeof(float));

// [ShapeKind]
static constexpr ShapeInfo kShapeInfo[kShapeKinds] = {
    {.name = "sphere", .rank = 0, .row = row_size<SphereRow>, .ball = true, .single = true},
    {.name = "box", .rank = 4, .row = row_size<BoxRow>, .margin = kBoxMargin},
    {.name = "circle",
     .rank = 0,
     .row = row_size<CircleRow>,
     .planar = true,
     .ball = true,
     .single = true},
    {.name = "rectangle", .rank = 3, .row = row_size<RectangleRow>, .planar = true},
    {.name = "polygon", .rank = 4, .row = row_size<PolygonRow>, .planar = true},
    {.name = "plane", .rank = 6, .row = row_size<PlaneRow>, .ground = true},
    {.name = "capsule", .rank = 1, .row = row_size<CapsuleRow>},
    {.name = "terrain", .rank = 6, .row = row_size<LinkRow>, .planar = true, .ground = true},
    {.name = "cylinder", .rank = 3, .row = row_size<BoxRow>, .margin = kBoxMargin, .general = true},
    {.name = "hull", .rank = 5, .row = row_size<HullRow>, .margin = kBoxMargin, .general = true},
    {.name = "rounded", .rank = 4, .row = row_size<PolygonRow>, .planar = true},
    {.name = "field", .rank = 6, .row = row_size<TileRow>, .margin = kBoxMargin, .ground = true},
    {.name = "ellipsoid",
     .rank = 2,
     .row = row_size<BoxRow>,
     .margin = kBoxMargin,
     .single = true,
     .general = true},
};
static inline constexpr const ShapeInfo& info(ShapeKind kind) {
  return kShapeInfo[static_cast<int>(kind)];
}

// Both shapes of a pair, A first: any two make one.
enum class PairKind : int {};
inline constexpr int kPairKinds = kShapeKinds * kShapeKinds;
static inline constexpr PairKind pair_of(ShapeKind a, ShapeKind b) {
  return static_cast<PairKind>(static_cast<int>(a) * kShapeKinds + static_cast<int>(b));
}
static inline constexpr ShapeKind shape_a(PairKind kind) {
  return static_cast<ShapeKind>(static_cast<int>(kind) / kShapeKinds);
}
static inline constexpr ShapeKind shape_b(PairKind kind) {
  return static_cast<ShapeKind>(static_cast<int>(kind) % kShapeKinds);
}

// Is A the shape that it would be if both moved? If not, A is fixed.
static inline constexpr bool may_both_move(PairKind kind) {
  return !info(shape_a(kind)).ground && info(shape_a(kind)).rank >= info(shape_b(kind)).rank;
}
static inline constexpr bool is_plane(PairKind kind) { return shape_a(kind) == ShapeKind::plane; }
static inline constexpr bool is_tile(PairKind kind) { return shape_a(kind) == ShapeKind::tile; }
// Has a manifold at most one point?
static inline constexpr bool is_single(PairKind kind) {
  return info(shape_a(kind)).single || info(shape_b(kind)).single;
}
// Are both balls, so that their bounds tell how far they are apart?
static inline constexpr bool is_round(PairKind kind) {
  return info(shape_a(kind)).ball && info(shape_b(kind)).ball;
}

}  // namespace manyworlds::kernels
