// Sets of bodies, as a forest over parent[]: its lowest body is the root of each.
#pragma once

#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Halves the path on its way.
MW_INLINE int root_of(std::int32_t* parent, int body) {
  while (parent[body] != body) body = parent[body] = parent[parent[body]];
  return body;
}
MW_INLINE void unite(std::int32_t* parent, int a, int b) {
  const int root_a = root_of(parent, a), root_b = root_of(parent, b);
  parent[root_a < root_b ? root_b : root_a] = root_a < root_b ? root_a : root_b;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
