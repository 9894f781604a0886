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

// Places of the points along directions of A. Points that are not there repeat the first.
MW_INLINE void put_places(Vec3 u, Vec3 v, Mask use, Manifold<Isotropic, 4>& m) {
  for (int i = 0; i < 4; ++i) {
    const Vec3 at = select(m.valid[i], m.point_a[i], m.point_a[0]);
    m.feature_x[i] = select(use, dot(u, at), m.feature_x[i]);
    m.feature_y[i] = select(use, dot(v, at), m.feature_y[i]);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
