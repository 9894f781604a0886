// Constants that may differ from world to world, read as one number per lane. Where none differs
// every group sees the same block, so the kernels neither know nor ask.
#pragma once

#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

using Material = kernels::MaterialOf<LaneNumber>;

MW_INLINE const Material* materials(const Group& g) {
  return reinterpret_cast<const Material*>(g.constants.material);
}
MW_INLINE const kernels::BodyConstants<LaneNumber>& constants_of_body(const Group& g, int body) {
  return reinterpret_cast<const kernels::BodyConstants<LaneNumber>*>(g.constants.body)[body];
}
MW_INLINE const kernels::ShapeConstants<LaneNumber>& constants_of_shape(const Group& g, int shape) {
  return reinterpret_cast<const kernels::ShapeConstants<LaneNumber>*>(g.constants.shape)[shape];
}
MW_INLINE const kernels::PolygonConstants<LaneNumber>& constants_of_polygon(const Group& g,
                                                                            int shape) {
  return reinterpret_cast<const kernels::PolygonConstants<LaneNumber>*>(g.constants.polygon)[shape];
}

// Where the fields of a body's state are.
template <class S>
inline constexpr kernels::StateOffsets kState =
    kernels::state_offsets(S::kDim == 2 ? kernels::Dimension::planar : kernels::Dimension::spatial);

MW_INLINE Real* state_of(const Constants& t, const Group& g, int body, int component) {
  return g.state + (body * t.state_stride + component) * kLanes;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
