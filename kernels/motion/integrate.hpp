// The motion side of a contact step: velocities into the solver's layout, delta_v, displacements.
//
// Warm starting costs no pass after the first substep: Jacobians and masses are constant during a
// step, so the velocity change that the accumulated impulses make is the difference of velocities
// (impulse_part), and adding it to the next substep's velocity is the warm start.
#pragma once

#include "kernels/motion/rotate.hpp"
#include "kernels/rows/body_rows.hpp"
#include "kernels/rows/velocities.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
inline constexpr int kVelocityBlock = (S::kDim + S::kAng) * kLanes;  // dense, one body

// Runs update(offset of a register in the velocity-like arrays, delta_v, factor) over all of them.
template <class S, bool kDense, class Update>
MW_INLINE void for_each_register(const Constants& t, const Work& w, Update update) {
  if constexpr (kDense) {
    for (int b = 0; b < t.bodies; ++b) {
      for (int c = 0; c < S::kDim + S::kAng; ++c) {
        const int at = b * kVelocityBlock<S> + c * kLanes;
        const int shared = b * S::kRow + c;
        update(at, w.delta_v ? Float::load(w.delta_v + at) : Float(t.delta_v_rows[shared]),
               w.factor ? Float::load(w.factor + at) : Float(t.factor_rows[shared]));
      }
    }
  } else {
    const int block = w.rows_per_lane * S::kRow;
    for (int l = 0; l < kLanes; ++l) {
      for (int i = 0; i < block; i += kLanes) {
        const int at = l * block + i;
        const Float delta_v = Float::load((w.delta_v ? w.delta_v + l * block : t.delta_v_rows) + i);
        const Float factor = Float::load((w.factor ? w.factor + l * block : t.factor_rows) + i);
        update(at, delta_v, factor);
      }
    }
  }
}

template <class S>
MW_INLINE void offsets_of_body(const Work& w, int body, std::int32_t* o) {
  for (int l = 0; l < kLanes; ++l) o[l] = w.velocity_base[l] + body * S::kRow;
}

template <class S, bool kDense>
MW_INLINE void put_velocity(const Work& w, Real* array, int body, const Velocity<S>& v) {
  if constexpr (kDense) {
    store_velocity_dense(array + body * kVelocityBlock<S>, v);
  } else {
    alignas(64) std::int32_t o[kLanes];
    offsets_of_body<S>(w, body, o);
    store_velocity_row(S{}, array, o, v);
  }
}
template <class S, bool kDense>
MW_INLINE Velocity<S> get_velocity(const Work& w, const Real* array, int body) {
  if constexpr (kDense) {
    return load_velocity_dense<S>(array + body * kVelocityBlock<S>);
  } else {
    alignas(64) std::int32_t o[kLanes];
    offsets_of_body<S>(w, body, o);
    return load_velocity_row(S{}, array, o);
  }
}
// Of the angular velocity alone, if it has been got from there.
template <bool kDense>
MW_INLINE void put_spin(const Work& w, Real* array, int body, const Velocity<Tensor>& v) {
  if constexpr (kDense) {
    store(array + body * kVelocityBlock<Tensor> + Tensor::kDim * kLanes, v.w);
  } else {
    put_velocity<Tensor, kDense>(w, array, body, v);
  }
}

// Does a control act on this body?
MW_INLINE bool is_thrust(const Constants& t, int body) {
  return t.first_thrust && t.first_thrust[body] != t.first_thrust[body + 1];
}

// Force, N, and torque about the centre of mass, N m, of the inputs and the controls, for a body
// that is rotated by `orientation`.
template <class S>
struct Load {
  typename S::Vec force;
  typename S::Ang torque;
};
template <class S>
MW_INLINE Load<S> load_of_body(const Constants& t, const Group& g, int body,
                               const Real* orientation) {
  using Vec = typename S::Vec;
  Load<S> out{zero_of<Vec>(), zero_of<typename S::Ang>()};
  if (g.force) {
    const Real* f = g.force + body * 6 * kLanes;
    out.force = load_as<Vec>(f);
    out.torque = load_as<typename S::Ang>(f + (S::kDim == 3 ? 3 : 5) * kLanes);
  }
  if (!is_thrust(t, body)) return out;
  const auto q = load_as<typename S::Orientation>(orientation);
  for (int i = t.first_thrust[body]; i < t.first_thrust[body + 1]; ++i) {
    const auto& constants =
        reinterpret_cast<const kernels::ThrustConstants<LaneNumber>*>(g.constants.thrust)[i];
    const Float control = Float::load(g.control + t.thrust[i].control * kLanes);
    if constexpr (S::kDim == 2) {
      if (t.thrust[i].torque) {
        out.torque = fma(Float(constants.direction[2]), control, out.torque);
        continue;
      }
      const Vec thrust = rotate(q, {constants.direction[0], constants.direction[1]}) * control;
      out.force = out.force + thrust;
      out.torque = out.torque + cross(rotate(q, {constants.point[0], constants.point[1]}), thrust);
    } else {
      const LaneNumber *d = constants.direction, *p = constants.point;
      const Vec thrust = rotate(q, Vec{d[0], d[1], d[2]}) * control;
      if (t.thrust[i].torque) {
        out.torque = out.torque + thrust;
        continue;
      }
      out.force = out.force + thrust;
      out.torque = out.torque + cross(rotate(q, Vec{p[0], p[1], p[2]}), thrust);
    }
  }
  return out;
}

// What gravity and the inputs add to the velocity of a body in one substep.
template <class S>
MW_INLINE Velocity<S> delta_v_of_body(const Constants& t, const Group& g, const Work& w, int body) {
  // The sum starts from the same number that a group without forces adds: a world's bits must not
  // tell whether a force acts on another one.
  const auto& constants = constants_of_body(g, body);
  Velocity<S> delta_v;
  delta_v.v.x = constants.delta_v[0], delta_v.v.y = constants.delta_v[1];
  if constexpr (S::kDim == 3) delta_v.v.z = constants.delta_v[2];
  delta_v.w = zero_of<typename S::Ang>();
  if (t.attractors > 0 && !t.body[body].kinematic) {
    delta_v.v = fma(attraction_of_body<S>(t, g, body), Float(t.h), delta_v.v);
  }
  if (!g.force && !is_thrust(t, body)) return delta_v;
  const Load<S> load = load_of_body<S>(t, g, body, state_of(t, g, body, kState<S>.orientation));
  alignas(64) std::int32_t o[kLanes];
  for (int l = 0; l < kLanes; ++l) o[l] = w.body_base[l] + body * body_row_size(S::kKind);
  BodyRow<S> row;
  load_body_row(t, w, o, row);
  const Float h(t.h), scale = row.inv_mass * h;
  delta_v.v = fma(load.force, scale, delta_v.v);
  delta_v.w = apply(row.inertia, load.torque) * h;
  return delta_v;
}

// The dummy's row and what follows it.
template <class S, bool kDense>
MW_INLINE void clear_padding(const Constants& t, const Work& w, Real* array) {
  if constexpr (!kDense) {
    const int block = w.rows_per_lane * S::kRow;
    for (int l = 0; l < kLanes; ++l) {
      for (int i = t.bodies * S::kRow; i < block; ++i) array[l * block + i] = Real(0);
    }
  }
}

template <class S, bool kDense>
void enter_velocities(const Constants& t, const Group& g, Work& w) {
  const Float zero(Real(0));
  for (int b = 0; b < t.bodies; ++b) {
    const Velocity<S> v{load_as<typename S::Vec>(state_of(t, g, b, kState<S>.linear)),
                        load_as<typename S::Ang>(state_of(t, g, b, kState<S>.angular))};
    put_velocity<S, kDense>(w, w.velocity, b, v);
  }
  const bool own = g.force || t.delta_v_varies || t.first_thrust || t.attractors > 0;
  w.delta_v = own ? w.delta_v_storage : nullptr;
  if (w.delta_v) {
    clear_padding<S, kDense>(t, w, w.delta_v);
    for (int b = 0; b < t.bodies; ++b) {
      put_velocity<S, kDense>(w, w.delta_v, b, delta_v_of_body<S>(t, g, w, b));
    }
  }
  w.factor = t.drag_varies ? w.factor_storage : nullptr;
  if constexpr (kDense) {
    for (int i = 0; i < t.bodies * kVelocityBlock<S>; i += kLanes) zero.store(w.displacement + i);
    for (int i = 0; t.has_joints && i < kVelocityBlock<S>; i += kLanes) {
      const int at = world_body(t) * kVelocityBlock<S> + i;
      zero.store(w.velocity + at), zero.store(w.displacement + at), zero.store(w.warmed + at);
    }
  } else {
    const int block = w.rows_per_lane * S::kRow;
    for (int i = 0; i < kLanes * block; i += kLanes) zero.store(w.displacement + i);
    clear_padding<S, kDense>(t, w, w.velocity);
  }
}

// What drag leaves of velocities in a substep, where that is not the same in all lanes.
template <class S, bool kDense>
void enter_factors(const Constants& t, const Group& g, Work& w) {
  if (!w.factor) return;
  clear_padding<S, kDense>(t, w, w.factor);
  for (int b = 0; b < t.bodies; ++b) {
    const auto& constants = constants_of_body(g, b);
    const Float linear = constants.linear_factor, angular = constants.angular_factor;
    if constexpr (S::kDim == 3) {
      put_velocity<S, kDense>(w, w.factor, b,
                              {{linear, linear, linear}, {angular, angular, angular}});
    } else {
      put_velocity<S, kDense>(w, w.factor, b, {{linear, linear}, angular});
    }
  }
}

// A velocity after what gravity, inputs and drag do to it in a substep.
MW_INLINE Float pulled(const Constants& t, Float v, Float delta_v, Float factor) {
  v = v + delta_v;
  return t.has_drag ? v * factor : v;
}

// Velocities at the start of the first substep, before any impulse; impulse_part keeps them.
template <class S, bool kDense>
void apply_first_delta_v(const Constants& t, const Group& g, Work& w) {
  enter_factors<S, kDense>(t, g, w);
  if constexpr (std::is_same_v<S, Tensor>) {
    for (int b = 0; b < t.bodies; ++b) {
      const std::uint32_t lanes = t.body[b].rotated ? w.swept[b] : w.touched[b];
      if (lanes == 0 || t.body[b].kinematic) continue;  // kinematic: no inertia
      const Vec3 moments = relative_moments(constants_of_body(g, b));
      const Mat3 r = matrix(load_quat(state_of(t, g, b, kState<S>.orientation)));
      Velocity<S> v = get_velocity<S, kDense>(w, w.velocity, b);
      v.w = select(mask_from_bits(lanes), implicit_gyroscopic(t.dt, moments, r, v.w), v.w);
      put_velocity<S, kDense>(w, w.velocity, b, v);
    }
  }
  for_each_register<S, kDense>(t, w, [&](int at, Float delta_v, Float factor) {
    const Float v = pulled(t, Float::load(w.velocity + at), delta_v, factor);
    v.store(w.velocity + at);
    v.store(w.impulse_part + at);
  });
}

template <class S, bool kDense>
void begin_substeps(const Constants& t, Work& w) {
  w.substep = w.sweep = 0;
  for_each_register<S, kDense>(t, w, [&](int at, Float, Float) {
    const Float v = Float::load(w.velocity + at);
    (v - Float::load(w.impulse_part + at)).store(w.impulse_part + at);
    v.store(w.warmed + at);
  });
}

// Joints warm start by themselves, since their Jacobians change from substep to substep: what they
// have done before is left out of impulse_part.
template <class S, bool kDense>
void mark_velocities(const Constants& t, Work& w) {
  for_each_register<S, kDense>(
      t, w, [&](int at, Float, Float) { Float::load(w.velocity + at).store(w.warmed + at); });
}
template <class S, bool kDense>
void gather_impulses(const Constants& t, Work& w) {
  for_each_register<S, kDense>(t, w, [&](int at, Float, Float) {
    const Float v = Float::load(w.velocity + at);
    (Float::load(w.impulse_part + at) + (v - Float::load(w.warmed + at)))
        .store(w.impulse_part + at);
    v.store(w.warmed + at);
  });
}

template <class S, bool kDense>
void advance_displacement(const Constants& t, Work& w) {
  const Float h(t.h);
  for_each_register<S, kDense>(t, w, [&](int at, Float, Float) {
    fma(h, Float::load(w.velocity + at), Float::load(w.displacement + at))
        .store(w.displacement + at);
  });
}

template <class S, bool kDense>
void next_substep(const Constants& t, Work& w) {
  ++w.substep, w.sweep = 0;
  const auto update = [&](int at, Float delta_v, Float factor) __attribute__((always_inline)) {
    const Float v = Float::load(w.velocity + at);
    const Float part = Float::load(w.impulse_part + at) + (v - Float::load(w.warmed + at));
    const Float next = pulled(t, v, delta_v, factor) + part;
    part.store(w.impulse_part + at);
    next.store(w.velocity + at);
    next.store(w.warmed + at);
  };
  for_each_register<S, kDense>(t, w, update);
}

// All substeps of bodies that no impulse reaches, in registers: what the passes above do to them,
// operation by operation.
template <class S>
void free_substeps(const Constants& t, Work& w) {
  const Float h(t.h);
  const auto update = [&](int at, Float delta_v, Float factor) __attribute__((always_inline)) {
    Float v = pulled(t, Float::load(w.velocity + at), delta_v, factor);
    Float moved = fma(h, v, Float::load(w.displacement + at));
    const Float part = v - v;  // impulses have done nothing, which makes -0 a 0
    for (int k = 1; k < t.substeps; ++k) {
      v = pulled(t, v, delta_v, factor) + part;
      moved = fma(h, v, moved);
    }
    v.store(w.velocity + at);
    moved.store(w.displacement + at);
  };
  for_each_register<S, true>(t, w, update);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
