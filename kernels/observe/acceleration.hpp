// Accelerations over the last step: a = (v - v0) / dt of the centre of mass, with all impulses of
// the step, and (w - w0) / dt. The start of the step waits where the result is put. An
// accelerometer tells R^T (a - g), g what the plan's gravity and attractors give the body: 0 in
// free fall, -g at rest. A body that is asleep has no acceleration; one that is disabled or frozen
// tells 0.
#pragma once

#include "kernels/observe/observe.hpp"
#include "kernels/rows/body_rows.hpp"
#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
struct AccelerationRows {
  Real *linear, *angular, *proper;
  MW_INLINE AccelerationRows(const ObserverView& o, int body) {
    Real* rows =
        rows_for(o, Observer::acceleration) + body * rows_of(Observer::acceleration) * kLanes;
    linear = rows + row_of(Observed::linear_acceleration) * kLanes;
    angular = rows + (row_of(Observed::angular_acceleration) + (S::kDim == 2 ? 2 : 0)) * kLanes;
    proper = rows + row_of(Observed::proper_acceleration) * kLanes;
  }
};

template <class S>
void begin_acceleration(const Constants& t, const Group& g, kernels::Scratch*,
                        const ObserverView& o) {
  for (int b = 0; b < t.bodies; ++b) {
    const AccelerationRows<S> rows(o, b);
    store(rows.linear, load_as<typename S::Vec>(state_of(t, g, b, kState<S>.linear)));
    store(rows.angular, load_as<typename S::Ang>(state_of(t, g, b, kState<S>.angular)));
  }
}

// Half a step before the state that there is, where the step has taken attractors.
template <class S>
MW_INLINE typename S::Vec gravity_of_body(const Constants& t, const Group& g, int body) {
  using Vec = typename S::Vec;
  const auto& constants = constants_of_body(g, body);
  Vec out;
  out.x = constants.gravity[0], out.y = constants.gravity[1];
  if constexpr (S::kDim == 3) out.z = constants.gravity[2];
  if (t.attractors == 0 || t.body[body].kinematic) return out;
  const Vec x =
      fma(load_as<Vec>(state_of(t, g, body, kState<S>.linear)), Float(t.step_dt * Real(-0.5)),
          load_as<Vec>(state_of(t, g, body, kState<S>.position)));
  for (int i = 0; i < t.attractors; ++i) {
    out = out + Attraction<S>(g, body, i, x).acceleration();
  }
  return out;
}

// A vector of the world in the axes of the body as its user gave them.
template <class S>
MW_INLINE typename S::Vec in_body_axes(const Constants& t, const Group& g, const ObserverView& o,
                                       int body, typename S::Vec a) {
  if (!t.has_orientation) return a;
  const auto q = load_as<typename S::Orientation>(state_of(t, g, body, kState<S>.orientation));
  if constexpr (S::kDim == 2) {
    return rotate_inverse(q, a);
  } else {
    a = rotate_back(q, a);
    if (!o.frames) return a;
    return rotate_back(load_quat(o.frames + (body * kernels::kFrameRows + 3) * kLanes), a);
  }
}

template <class S>
void observe_acceleration(const Constants& t, const Group& g, kernels::Scratch*,
                          const ObserverView& o) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const Float per_step(Real(1) / t.step_dt);
  const std::uint32_t frozen = frozen_lanes(g);
  const bool idle = has_idle_bodies(g);
  for (int b = 0; b < t.bodies; ++b) {
    const Mask moves = mask_from_bits(kAllLanes & ~(frozen | (idle ? idle_lanes(g, b) : 0)));
    const Mask there = mask_from_bits(kAllLanes & ~(frozen | (idle ? g.absent[b] : 0)));
    const AccelerationRows<S> rows(o, b);
    const auto change = [&](auto now, const Real* start) {
      return (now - load_as<decltype(now)>(start)) * per_step;
    };
    const auto v = load_as<Vec>(state_of(t, g, b, kState<S>.linear));
    const auto w = load_as<Ang>(state_of(t, g, b, kState<S>.angular));
    const Vec a = select(moves, change(v, rows.linear), zero_of<Vec>());
    store(rows.linear, a);
    store(rows.angular, select(moves, change(w, rows.angular), zero_of<Ang>()));
    const Vec felt = in_body_axes<S>(t, g, o, b, a - gravity_of_body<S>(t, g, b));
    store(rows.proper, select(there, felt, zero_of<Vec>()));
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
