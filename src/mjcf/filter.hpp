// Collision filters. MuJoCo lets two geoms collide when
//   (contype1 & conaffinity2) || (contype2 & conaffinity1),
// one direction being enough; ours needs both category & mask tests. The relation is symmetric and
// depends only on the (contype, conaffinity) pair of each geom. So each distinct pair becomes a
// class with a category bit of its own, whose mask holds the bits of the classes it collides with:
// exact for any bits, as long as there are no more classes than bits.
#pragma once

#include <vector>

#include "manyworlds/scene.hpp"
#include "src/mjcf/model.hpp"

namespace manyworlds::mjcf {

inline constexpr int kMaxFilterClasses = 32;

// Number of distinct (contype, conaffinity) pairs among the geoms that collide at all.
int filter_classes(const Model& model);

// The filter of each geom, in MuJoCo's order; {0, 0} for one that never collides.
// Precondition: filter_classes(model) <= kMaxFilterClasses.
std::vector<Filter> filters(const Model& model);

}  // namespace manyworlds::mjcf
