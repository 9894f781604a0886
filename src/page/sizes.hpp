// Sizes of shapes that are not the same in all worlds.
#pragma once

#include <cstddef>
#include <vector>

#include "manyworlds/batch.hpp"
#include "src/page/look.hpp"

namespace manyworlds::page {

struct VariedSize {
  std::size_t shape = 0;           // among all shapes of the scene
  std::vector<float> values = {};  // [world] size x y z, stretch x y z, of the shape's mesh
};

// Of `worlds` worlds of one kind from `first` on, the shapes whose size differs from the scene's in
// any of them.
std::vector<VariedSize> sizes_of(const Batch& batch, int first, int worlds, Meshes& meshes);

}  // namespace manyworlds::page
