// What the families of the law "no penetration" share.
#pragma once

#include <vector>

#include "tools/invariants/draw.hpp"

namespace manyworlds::invariants {

std::vector<Family> pile_families();  // penetration_piles.cpp
std::vector<Family> wall_families();  // penetration_walls.cpp
std::vector<Family> seam_families();  // penetration_seams.cpp

// A dynamic body of one shape, in the frame of its body.
struct Piece {
  std::size_t body = 0;  // in the scene
  Geometry geometry = Sphere{};
  double thickness = 0;  // half of the least width, m
  double radius = 0;     // of the sphere about its origin, m
};
Piece piece_of(BodyId body, const Geometry& geometry);
Body dynamic_body(const Geometry& geometry, const Material& material);
Material draw_surface(Random& random, double restitution = 1);

// Flat or slender: an ellipsoid, a pebble, hulls of 40 and 64 vertices, a box, a coin, a capsule;
// in the plane a box, a capsule, an octagon, a rounded box. The largest half extent is `size`.
Geometry draw_flat(Random& random, Space space, double size);
int flat_types(Space space);
Geometry draw_flat(Random& random, Space space, double size, int type);

// A size for small bodies: 0.01 to 1 of the length, and not below 1 cm on Earth at 60 steps a
// second, or what is similar to that.
double draw_small_size(Random& random, const Scale& scale);

// How far a body reaches along a direction of the world, from its origin.
double reach(const Piece& piece, Space space, const BodyNow& now, const Vec3& direction);
// The point of a shape that is farthest along a direction, in its frame.
Vec3 support(const Geometry& geometry, Space space, const Vec3& direction);

bool finite(const BodyNow& now);
double slop_of(const Scene& scene);

}  // namespace manyworlds::invariants
