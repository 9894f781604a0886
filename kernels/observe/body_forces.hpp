// Links and external forces of plans without trees: places of the state; the contacts of the last
// step (contacts.hpp) and the inputs of the call.
#pragma once

#include "kernels/observe/points.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
void observe_bodies(const Constants& t, const Group& g, kernels::Scratch*, const ObserverView& o) {
  using Vec = typename S::Vec;
  if (t.tree.links > 0) return;
  for (int b = 0; b < t.bodies; ++b) {
    const auto x = load_as<Vec>(state_of(t, g, b, kState<S>.position));
    Real* rows = rows_for(o, Observer::links) + b * rows_of(Observer::links) * kLanes;
    store(rows + row_of(Observed::link_position) * kLanes,
          x + turned_arm_of<S>(t, g, o, {b, {0, 0, 0}}));
    store(rows + row_of(Observed::link_center) * kLanes, x);
  }
}

// Before the step, which adds contacts.
inline void begin_forces(const Constants& t, const Group&, kernels::Scratch*,
                         const ObserverView& o) {
  if (t.tree.links > 0) return;
  Real* rows = rows_for(o, Observer::link_forces);
  const int count = items_of(o, Observer::link_forces) * rows_of(Observer::link_forces);
  for (int i = 0; i < count; ++i) Float(Real(0)).store(rows + i * kLanes);
}
// After it; inputs act on the centre of mass of dynamic bodies.
inline void add_inputs(const Constants& t, const Group& g, kernels::Scratch*,
                       const ObserverView& o) {
  if (t.tree.links > 0 || !g.force) return;
  const Mask frozen = mask_from_bits(frozen_lanes(g));
  for (int b = 0; b < t.bodies; ++b) {
    if (t.body[b].kinematic) continue;
    const Mask out = frozen | absent_lanes(g, b);
    const Real* input = g.force + b * 6 * kLanes;
    Real* rows = rows_for(o, Observer::link_forces) + b * rows_of(Observer::link_forces) * kLanes;
    const auto add = [&](const Real* from, Real* to) {
      const Vec3 v = load_vec3(from);
      store(to, load_vec3(to) + select(out, zero_of<Vec3>(), v));
    };
    add(input, rows + row_of(Observed::external_force) * kLanes);
    add(input + 3 * kLanes, rows + row_of(Observed::external_torque) * kLanes);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
