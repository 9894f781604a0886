// Points fixed to bodies: where they are, p = x + R r, and their velocity, v + w x R r.
#pragma once

#include "kernels/observe/observe.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// From the centre of mass to the point, in the axes that the orientation rotates.
template <class S>
MW_INLINE typename S::Vec arm_of(const ObserverView& o, const kernels::PointTable<Real>& point) {
  typename S::Vec r;
  r.x = Float(point.position[0]), r.y = Float(point.position[1]);
  if constexpr (S::kDim == 3) r.z = Float(point.position[2]);
  if (!o.frames) return r;
  const Real* frame = o.frames + point.body * kernels::kFrameRows * kLanes;
  r = r - load_as<typename S::Vec>(frame);
  if constexpr (S::kDim == 3) r = rotate(load_quat(frame + 3 * kLanes), r);
  return r;
}

template <class S>
void observe_points(const Constants& t, const Group& g, kernels::Scratch*, const ObserverView& o) {
  using Vec = typename S::Vec;
  for (int i = 0; i < items_of(o, Observer::points); ++i) {
    const int body = o.point[i].body;
    Vec r = arm_of<S>(o, o.point[i]);
    if (t.has_orientation) {
      r = rotate(load_as<typename S::Orientation>(state_of(t, g, body, kState<S>.orientation)), r);
    }
    const auto x = load_as<Vec>(state_of(t, g, body, kState<S>.position));
    const auto v = load_as<Vec>(state_of(t, g, body, kState<S>.linear));
    const auto w = load_as<typename S::Ang>(state_of(t, g, body, kState<S>.angular));
    Real* rows = rows_for(o, Observer::points) + i * rows_of(Observer::points) * kLanes;
    store(rows + row_of(Observed::point_position) * kLanes, x + r);
    store(rows + row_of(Observed::point_velocity) * kLanes, v + cross(w, r));
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
