// Kinds of shapes, and of pairs of them: which shape is A, and what follows from the two alone.
#pragma once

namespace manyworlds::kernels {

enum class ShapeKind : int {
  sphere,
  box,
  circle,
  rectangle,
  polygon,
  plane,
  capsule,
  link,
  cylinder,
  hull,
  rounded,  // polygon
  tile,     // of a height field
};
inline constexpr int kShapeKinds = 12;

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

// Shapes that only fixed bodies have; they are always A.
static inline constexpr bool is_ground(ShapeKind kind) {
  return kind == ShapeKind::plane || kind == ShapeKind::link || kind == ShapeKind::tile;
}
// A sphere or a circle touches at one point.
static inline constexpr bool is_ball(ShapeKind kind) {
  return kind == ShapeKind::sphere || kind == ShapeKind::circle;
}

// Of two shapes that move the one with more faces is A. A fixed shape is A whatever it is.
static inline constexpr int rank_as_a(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::sphere:
    case ShapeKind::circle: return 0;
    case ShapeKind::capsule: return 1;
    case ShapeKind::cylinder:
    case ShapeKind::rectangle: return 2;
    case ShapeKind::box:
    case ShapeKind::polygon:
    case ShapeKind::rounded: return 3;
    case ShapeKind::hull: return 4;
    default: return 5;
  }
}
// Is A the shape that it would be if both moved? If not, A is fixed.
static inline constexpr bool may_both_move(PairKind kind) {
  return !is_ground(shape_a(kind)) && rank_as_a(shape_a(kind)) >= rank_as_a(shape_b(kind));
}

static inline constexpr bool is_plane(PairKind kind) { return shape_a(kind) == ShapeKind::plane; }
static inline constexpr bool is_tile(PairKind kind) { return shape_a(kind) == ShapeKind::tile; }
// Has a manifold at most one point?
static inline constexpr bool is_single(PairKind kind) {
  return is_ball(shape_a(kind)) || is_ball(shape_b(kind));
}

}  // namespace manyworlds::kernels
