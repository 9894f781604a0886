// How many tiles a height field is cut into, so that each shape lies over no more (see
// kernels/collide/tile.hpp). Used inside src only.
#pragma once

#include "manyworlds/scene.hpp"

namespace manyworlds {

inline constexpr int kMaxTiles = 128;  // of a height field

struct TileCount {
  int wide = 1, deep = 1;  // cells along x and y
  int count() const { return 2 * wide * deep; }
};
// Of the shapes of a scene that may move, at their largest. Precondition: they have sound sizes.
TileCount tiles_of(const HeightField& field, const Scene& scene);
// m, by which the tiles that a shape looks at reach beyond it.
double tile_pad(const Scene& scene);

}  // namespace manyworlds
