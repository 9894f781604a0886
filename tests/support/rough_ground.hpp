// Slow twin of rough ground: how far a body overlaps a height field or a terrain, by walking along
// a line out of each, instead of by the kernels' tiles, links and clipping.
#pragma once

#include "tests/support/solid.hpp"

namespace manyworlds::test {

// The solid below a height field, or below an open terrain that runs from left to right. Its shape
// and body frames are those of the world.
class RoughGround {
 public:
  explicit RoughGround(const Geometry& geometry) : geometry_(geometry) {}
  bool contains(const Vec3& point) const;

 private:
  Geometry geometry_;
};

// m; how deep the overlap is that a contact's point and normal are about. `depth`: what it reports,
// so that half of it below the point a place of the body is, and half of it above one of the
// ground. Where either is there, within `slack`: how far it is from it along the normal out of the
// other. 0 where neither is.
double overlap_at(const RoughGround& ground, const Solid& body, const Vec3& point,
                  const Vec3& normal, double depth, double slack);

}  // namespace manyworlds::test
