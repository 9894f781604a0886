// A shape that moves, where its body has taken it: what the begin stage makes pose rows and bounds
// from.
#pragma once

#include "kernels/work/constants.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class VecType, class RotationType>
struct PlacementOf {
  using Vec = VecType;

  const kernels::ColliderTable& collider;
  const kernels::ShapeConstants<LaneNumber>& constants;
  const kernels::PolygonConstants<LaneNumber>* polygon;  // nullptr in plans without polygons
  Vec p;                                                 // of the shape frame, world
  RotationType r;
  Float margin;  // by which bounds reach beyond the shape, m
  Real* rows;    // where its pose row goes:
  const std::int32_t* offset;
};
using SpatialPlacement = PlacementOf<Vec3, Mat3>;
using PlanarPlacement = PlacementOf<Vec2, Rot2>;

// An axis-aligned box around a shape, margin included, world.
template <class Vec>
struct BoundsOf {
  Vec centre, half;
};

MW_INLINE Vec3 half_extents(const kernels::ShapeConstants<LaneNumber>& c) {
  return {c.half[0], c.half[1], c.half[2]};
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
