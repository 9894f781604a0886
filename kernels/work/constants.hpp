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
MW_INLINE const kernels::LinkConstants<LaneNumber>& constants_of_link(const Group& g, int link) {
  return reinterpret_cast<const kernels::LinkConstants<LaneNumber>*>(g.constants.link)[link];
}
MW_INLINE const kernels::DragConstants<LaneNumber>& constants_of_drag(const Group& g, int link) {
  return reinterpret_cast<const kernels::DragConstants<LaneNumber>*>(g.constants.drag)[link];
}
MW_INLINE const kernels::DofConstants<LaneNumber>& constants_of_dof(const Group& g, int dof) {
  return reinterpret_cast<const kernels::DofConstants<LaneNumber>*>(g.constants.dof)[dof];
}
MW_INLINE const kernels::ActuatorConstants<LaneNumber>& constants_of_actuator(const Group& g,
                                                                              int actuator) {
  using Of = kernels::ActuatorConstants<LaneNumber>;
  return reinterpret_cast<const Of*>(g.constants.actuator)[actuator];
}
MW_INLINE const kernels::LimitConstants<LaneNumber>& constants_of_limit(const Group& g, int limit) {
  return reinterpret_cast<const kernels::LimitConstants<LaneNumber>*>(g.constants.limit)[limit];
}
MW_INLINE const kernels::Compliance<LaneNumber>& compliance_of_contact(const Group& g, int index) {
  return reinterpret_cast<const kernels::Compliance<LaneNumber>*>(g.constants.contact)[index];
}
MW_INLINE const kernels::AttractorConstants<LaneNumber>& constants_of_attractor(const Group& g,
                                                                                int attractor) {
  using Of = kernels::AttractorConstants<LaneNumber>;
  return reinterpret_cast<const Of*>(g.constants.attractor)[attractor];
}

// Where the fields of a body's state are.
template <class S>
inline constexpr kernels::StateOffsets kState =
    kernels::state_offsets(S::kDim == 2 ? kernels::Dimension::planar : kernels::Dimension::spatial);

MW_INLINE Real* state_of(const Constants& t, const Group& g, int body, int component) {
  return g.state + (body * t.state_stride + component) * kLanes;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
