// Which kernel a pair of shapes goes to, and how the pairs of a plan are collected.
#pragma once

#include <utility>

#include "src/plan/plan_data.hpp"

namespace manyworlds {

struct KindOfPair {
  kernels::PairKind kind;
  kernels::ListId list;
  bool swapped;  // A is the second

  // Of its class among the classes of a plan, which are the order of rows and so of bits.
  using Place = std::pair<int, int>;
  Place place() const;
};
// `fixed`: the first is, and stays A.
KindOfPair kind_of_pair(kernels::ShapeKind a, kernels::ShapeKind b, bool fixed);

inline bool resists(const Material& m) {
  return m.rolling_resistance > 0 || m.torsional_resistance > 0;
}

// Classes of a sparse plan: how many pairs they have, without listing them. Throws SceneError when
// there are more than keys can tell apart.
void count_pairs(PlanData& plan);  // sparse_pairs.cpp

}  // namespace manyworlds
