// Which of many points is farthest along a direction: cells of directions, each with the points
// that may be (kernels/shape/hull_tables.hpp).
#pragma once

#include <vector>

#include "manyworlds/shape.hpp"

namespace manyworlds {

// Directions d whose largest component is +-1, by the face of the cube around them and a grid on
// that: cell (face, j, i) has the other two components in the j-th and i-th of kMapCells equal
// parts of [-1, 1]. Faces are x, -x, y, -y, z, -z, and after x come y and z, after y come z and x,
// after z come x and y.
//
// Rows of four numbers: for every cell where its list begins, counted from the first, and how long
// it is, two cells in a row; then the lists, padded to whole rows. A list has, in their order,
// every point that for some direction in the cell is less than `margin` short of the farthest. No
// rows if lists are longer than kMostListed on average: then a map selects too little.
inline constexpr std::size_t kMostListed = 64;
std::vector<double> direction_map(const std::vector<Vec3>& points, double margin);

}  // namespace manyworlds
