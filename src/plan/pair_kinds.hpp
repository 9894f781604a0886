// Which kernel a pair of shapes goes to, and how the pairs of a plan are collected.
#pragma once

#include "src/plan/plan_data.hpp"

namespace manyworlds {

struct KindOfPair {
  kernels::PairKind kind;
  kernels::ListId list;
  bool swapped;  // A of the kernel is the second; a fixed shape is A all the same
};
KindOfPair kind_of_pair(kernels::ShapeKind a, kernels::ShapeKind b, bool fixed);  // pairs.cpp

// Classes of a sparse plan: how many pairs they have, without listing them. Throws SceneError when
// there are more than keys can tell apart.
void count_pairs(PlanData& plan);  // sparse_pairs.cpp

}  // namespace manyworlds
