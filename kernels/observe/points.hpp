// Points fixed to bodies: where they are, p = x + R r, and their velocity, v + w x R r; and sites
// of bodies and of the world, those of trees aside (kernels/observe/tree_links.hpp).
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
// In world axes.
template <class S>
MW_INLINE typename S::Vec turned_arm_of(const Constants& t, const Group& g, const ObserverView& o,
                                        const kernels::PointTable<Real>& point) {
  const typename S::Vec r = arm_of<S>(o, point);
  if (!t.has_orientation) return r;
  const Real* q = state_of(t, g, point.body, kState<S>.orientation);
  return rotate(load_as<typename S::Orientation>(q), r);
}

template <class S>
void observe_points(const Constants& t, const Group& g, kernels::Scratch*, const ObserverView& o) {
  using Vec = typename S::Vec;
  for (int i = 0; i < items_of(o, Observer::points); ++i) {
    const int body = o.point[i].body;
    const Vec r = turned_arm_of<S>(t, g, o, o.point[i]);
    const auto x = load_as<Vec>(state_of(t, g, body, kState<S>.position));
    const auto v = load_as<Vec>(state_of(t, g, body, kState<S>.linear));
    const auto w = load_as<typename S::Ang>(state_of(t, g, body, kState<S>.angular));
    Real* rows = rows_for(o, Observer::points) + i * rows_of(Observer::points) * kLanes;
    store(rows + row_of(Observed::point_position) * kLanes, x + r);
    store(rows + row_of(Observed::point_velocity) * kLanes, v + cross(w, r));
  }
}

template <class S>
void observe_sites(const Constants& t, const Group& g, kernels::Scratch*, const ObserverView& o) {
  using Vec = typename S::Vec;
  if (t.tree.links > 0) return;
  for (int i = 0; i < items_of(o, Observer::sites); ++i) {
    const kernels::PointTable<Real>& site = o.site[i];
    Vec x;
    x.x = Float(site.position[0]), x.y = Float(site.position[1]);
    if constexpr (S::kDim == 3) x.z = Float(site.position[2]);
    if (site.body >= 0) {
      x = load_as<Vec>(state_of(t, g, site.body, kState<S>.position)) +
          turned_arm_of<S>(t, g, o, site);
    }
    Real* rows = rows_for(o, Observer::sites) + i * rows_of(Observer::sites) * kLanes;
    store(rows + row_of(Observed::site_position) * kLanes, x);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
