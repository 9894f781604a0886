// Tiles of a height field: what a convex shape meets of one. The surface is made of triangles, two
// of each cell of a grid. A shape can lie over few cells at once; the plan counts them, and makes a
// tile for each (src/plan/height_field.cpp). Where a shape is decides which cell a tile is for it:
// the one below it whose column and row leave the tile's remainders when they are divided by how
// many there are. So a tile is the same triangle from step to step, and impulses find their place.
//
// Triangles have no thickness and what is below is solid. As with links of terrains, a contact's
// normal is only ever one that the surface has there: the triangle's own, or at an edge that sticks
// out one between its own and its neighbour's. So what slides or rolls from triangle to triangle
// does not catch on edges.
#pragma once

#include "kernels/collide/convex.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Codes of contacts that a tile's pairs tell apart (collide_convex.cpp).
inline constexpr Real kTileCodes = Real(65536);

// Edges run counter-clockwise seen from above; edge e goes from vertex e to the next.
struct Tile {
  Vec3 vertex[3], normal;  // from p of its ConvexShape, world axes; unit
  Vec3 out[3];             // unit, in the triangle's plane, out of it across edge e
  Vec3 last[3];            // unit, across that edge, along the surface that goes on; `out` at one
                           // that does not stick out
  Vec3 beside[3];          // unit, level in the field, out of the triangle seen from above
  Float code;              // of the cell, below 256
  Mask there;              // the cell is one of the field
};

// The tiles at `offset` under (over) b, in the lanes of `active`, and as shapes.
void load_tile(const Real* base, const std::int32_t* offset, const ConvexShape& b, Mask active,
               Tile& tile, ConvexShape& s);

// Whether the surface has this normal at the tile or at its edges.
Mask has_normal(const Tile& tile, Vec3 n);
// Whether a point, from the tile's p, is straight over the triangle, by no more than `slack`
// outside of it.
Mask is_over(const Tile& tile, Vec3 point, Float slack);

// Whether a point is in the solid below the triangle, seen along the field's z axis: below a valley
// the spaces straight under its slopes leave a wedge between them.
Mask is_below(const Tile& tile, Vec3 point);

// B is a sphere.
void collide_tile_sphere(const ConvexShape& a, const Tile& tile, const ConvexShape& b,
                         Manifold<Isotropic, 1>& m);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
