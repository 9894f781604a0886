// What the narrow phase finds of a pair of shapes.
#pragma once

#include "kernels/lane/space.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// One manifold as the narrow phase hands it over, in registers. Points in excess of what was
// found are not valid; separations of invalid points are still finite.
template <class S, int N>
struct Manifold {
  typename S::Vec normal;      // unit, from A to B, world
  typename S::Vec tangent;     // unit, along a feature of the reference shape (spatial)
  typename S::Vec point_a[N];  // from the shape origin of A, world axes, m
  typename S::Vec point_b[N];  // from the shape origin of B
  Float separation[N];
  Float feature_x[N], feature_y[N];
  Mask valid[N];
  // Points that touch nothing yet, but are the next to when the bodies turn about the others: near
  // enough for normal rows, not exact. Friction acts at the middle of the other points, and what is
  // told and carried over to the next step is theirs.
  Mask guard[N] = {};
  Float code;
  Float match_distance2;  // m^2: stored impulses are carried to points closer than this
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
