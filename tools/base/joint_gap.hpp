// How far joints have come apart.
#pragma once

#include "manyworlds/batch.hpp"

namespace manyworlds::tools {

// m: the most over all worlds that are not frozen, of balls, hinges and fixed joints the distance
// of their anchors, of sliders and wheels that across their axis. Other joints have no gap, nor
// have those of trees.
double max_joint_gap(const Batch& batch);

}  // namespace manyworlds::tools
