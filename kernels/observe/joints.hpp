// Joints after the step: coordinates and their speeds from the state, forces from the impulses that
// the last substep ended with.
#pragma once

#include "kernels/joint/coordinates.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A row at the present state; without effective mass, since it is not solved.
template <class S>
MW_INLINE void row_now(const Constants& t, const Group& g, const Work& w, const JointPart& part,
                       const Joint& constants, Row<S>& s) {
  const Float zero(Real(0));
  zero.store(s.start_value);
  for (int i = 0; i < 3; ++i) zero.store(s.start_axis[i]);
  prepare(t, g, part, constants, s);
  locate<S, true, false>(w, part, constants, s);
}

template <class S>
MW_INLINE void observe_coordinate(const Constants& t, const Group& g, const Work& w,
                                  const kernels::JointCoordinate& c, Real* rows) {
  Row<S> s;
  row_now(t, g, w, c.what, constants_of_part(g, c.part), s);
  const TwoBodies<S> v{velocity_of<S>(t, g, c.what.body_a), velocity_of<S>(t, g, c.what.body_b)};
  Float::load(s.value).store(rows + row_of(Observed::joint_position) * kLanes);
  speed_of(s, v).store(rows + row_of(Observed::joint_speed) * kLanes);
}

// Torques of the plane are about z, the last of three rows.
MW_INLINE void add_torque(Real* rows, Float l) {
  add_to(rows, row_of(Observed::joint_torque) + 2, l);
}
MW_INLINE void add_torque(Real* rows, Vec3 l) { add_to(rows, row_of(Observed::joint_torque), l); }

template <class S>
MW_INLINE void observe_load(const Constants& t, const Group& g, const Work& w, int part,
                            Real* rows) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const JointPart& what = t.part[part];
  const Real* stored = g.joint_impulse + part * kernels::kPartImpulses * kLanes;
  const Float inv_h(t.inv_h);
  const Float along =
      (Float::load(stored) + (Float::load(stored + kLanes) - Float::load(stored + 2 * kLanes))) *
      inv_h;
  switch (what.kind) {
    case PartKind::point:
    case PartKind::line: return add_to(rows, 0, load_as<Vec>(stored) * inv_h);
    case PartKind::lock:
    case PartKind::swing: return add_torque(rows, load_as<Ang>(stored) * inv_h);
    default: {
      Row<S> s;
      row_now(t, g, w, what, constants_of_part(g, part), s);
      if (is_linear(what.kind)) return add_to(rows, 0, load_as<Vec>(s.linear_b[0]) * along);
      return add_torque(rows, load_as<Ang>(s.angular_b[0]) * along);
    }
  }
}

template <class S>
void observe_joints(const Constants& t, const Group& g, kernels::Scratch* scratch,
                    const ObserverView& o) {
  const Work& w = work_of(scratch);
  for (int i = 0; i < items_of(o, Observer::joints); ++i) {
    const kernels::JointCoordinate& c = o.coordinate[i];
    Real* rows = rows_for(o, Observer::joints) + i * rows_of(Observer::joints) * kLanes;
    observe_coordinate<S>(t, g, w, c, rows);
  }
}

template <class S>
void observe_loads(const Constants& t, const Group& g, kernels::Scratch* scratch,
                   const ObserverView& o) {
  const Work& w = work_of(scratch);
  const Float zero(Real(0));
  constexpr int kRows = rows_of(Observer::joint_loads);
  Real* rows = rows_for(o, Observer::joint_loads);
  const int count = items_of(o, Observer::joint_loads) * kRows;
  for (int i = 0; i < count; ++i) zero.store(rows + i * kLanes);
  for (int i = 0; i < t.parts; ++i) {
    observe_load<S>(t, g, w, i, rows + o.joint_of_part[i] * kRows * kLanes);
  }
}

// What the drive or the spring of a joint did along its coordinates in the last substep.
inline void observe_drives(const Constants& t, const Group& g, const ObserverView& o) {
  const Mask live = mask_from_bits(~frozen_lanes(g) & kAllLanes);
  const Float zero(Real(0)), inv_h(t.inv_h);
  for (int i = 0; i < items_of(o, Observer::drives); ++i) {
    const kernels::JointCoordinate& c = o.coordinate[i];
    Float force = zero;
    const std::int32_t joint = t.part[c.part].joint;
    for (int p = c.part; p < t.parts && t.part[p].joint == joint; ++p) {
      if (t.part[p].kind != c.what.kind || !t.part[p].drive) continue;
      force = Float::load(g.joint_impulse + p * kernels::kPartImpulses * kLanes) * inv_h;
    }
    select(live, force, zero).store(rows_for(o, Observer::drives) + i * kLanes);
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
