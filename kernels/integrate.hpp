// The motion side of a contact step: velocities into the solver's layout, pushes, displacements.
//
// Warm starting costs no pass after the first substep: Jacobians and masses are constant during a
// step, so the velocity change that the accumulated impulses make is the difference of velocities
// (impulse_part), and adding it to the next substep's velocity is the warm start.
#pragma once

#include "kernels/constraint/prepare.hpp"
#include "kernels/rotate.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
inline constexpr int kVelocityBlock = (S::kDim + S::kAng) * kLanes;  // dense, one body

// Runs update(offset of a register in the velocity-like arrays, push, factor) over all of them.
template <class S, bool kDense, class Update>
MW_INLINE void for_each_register(const Tables& t, const Work& w, Update update) {
  if constexpr (kDense) {
    for (int b = 0; b < t.bodies; ++b) {
      for (int c = 0; c < S::kDim + S::kAng; ++c) {
        const int at = b * kVelocityBlock<S> + c * kLanes;
        const Float push = w.push ? Float::load(w.push + at) : Float(t.push_rows[b * S::kRow + c]);
        update(at, push, Float(t.factor_rows[b * S::kRow + c]));
      }
    }
  } else {
    const int block = w.rows_per_lane * S::kRow;
    for (int l = 0; l < kLanes; ++l) {
      for (int i = 0; i < block; i += kLanes) {
        const int at = l * block + i;
        const Float push = Float::load((w.push ? w.push + l * block : t.push_rows) + i);
        update(at, push, Float::load(t.factor_rows + i));
      }
    }
  }
}

// Where the parts of a body's state are. Only its length depends on has_orientation.
template <class S>
inline constexpr kernels::StateOffsets kState = kernels::state_offsets(
    S::kDim == 2 ? kernels::Dimension::planar : kernels::Dimension::spatial, true);

MW_INLINE Real* state_of(const Tables& t, const Group& g, int body, int component) {
  return g.state + (body * t.state_stride + component) * kLanes;
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

// What gravity and the inputs add to the velocity of a body in one substep.
template <class S>
MW_INLINE Velocity<S> push_of_body(const Tables& t, const Group& g, const Work& w, int body) {
  // The sum starts from the same number that a group without forces adds: a world's bits must not
  // tell whether another one is pushed.
  const Real* gravity = t.push_rows + body * S::kRow;
  const Real* f = g.force + body * 6 * kLanes;
  alignas(64) std::int32_t o[kLanes];
  for (int l = 0; l < kLanes; ++l) o[l] = w.body_base[l] + body * body_row_size(S::kKind);
  BodyRow<S> row;
  load_body_row(t, w, o, row);
  const Float h(t.h), scale = row.inv_mass * h;
  Velocity<S> push;
  push.v.x = fma(Float::load(f), scale, gravity[0]);
  push.v.y = fma(Float::load(f + kLanes), scale, gravity[1]);
  if constexpr (S::kDim == 3) {
    push.v.z = fma(Float::load(f + 2 * kLanes), scale, gravity[2]);
    push.w = apply(row.inertia, load_vec3(f + 3 * kLanes)) * h;
  } else {
    push.w = apply(row.inertia, Float::load(f + 5 * kLanes)) * h;
  }
  return push;
}

template <class S, bool kDense>
void enter_velocities(const Tables& t, const Group& g, Work& w) {
  const Float zero(Real(0));
  for (int b = 0; b < t.bodies; ++b) {
    const Velocity<S> v{load_as<typename S::Vec>(state_of(t, g, b, kState<S>.linear)),
                        load_as<typename S::Ang>(state_of(t, g, b, kState<S>.angular))};
    put_velocity<S, kDense>(w, w.velocity, b, v);
  }
  w.push = g.force ? w.push_storage : nullptr;
  if constexpr (kDense) {
    for (int i = 0; i < t.bodies * kVelocityBlock<S>; i += kLanes) zero.store(w.displacement + i);
  } else {
    const int block = w.rows_per_lane * S::kRow;
    for (int i = 0; i < kLanes * block; i += kLanes) zero.store(w.displacement + i);
    for (int l = 0; l < kLanes; ++l) {  // the dummy, and the padding after it
      for (int i = t.bodies * S::kRow; i < block; ++i) w.velocity[l * block + i] = Real(0);
    }
  }
}

// Velocities at the start of the first substep, before any impulse; impulse_part keeps them.
template <class S, bool kDense>
void first_push(const Tables& t, const Group& g, Work& w) {
  if (w.push) {
    if constexpr (!kDense) {
      const int block = w.rows_per_lane * S::kRow;
      for (int l = 0; l < kLanes; ++l) {
        for (int i = t.bodies * S::kRow; i < block; ++i) w.push[l * block + i] = Real(0);
      }
    }
    for (int b = 0; b < t.bodies; ++b) {
      put_velocity<S, kDense>(w, w.push, b, push_of_body<S>(t, g, w, b));
    }
  }
  if constexpr (std::is_same_v<S, Tensor>) {
    for (int b = 0; b < t.bodies; ++b) {
      const auto& body = t.body[b];
      if (w.touched[b] == 0 || body.inv_mass == Real(0)) continue;  // kinematic: no inertia
      const Quat q = load_quat(state_of(t, g, b, kState<S>.orientation));
      Velocity<S> v = get_velocity<S, kDense>(w, w.velocity, b);
      const Vec3 turned = implicit_gyroscopic(
          t.dt, {body.inertia[0], body.inertia[1], body.inertia[2]}, matrix(q), v.w);
      v.w = select(mask_from_bits(w.touched[b]), turned, v.w);
      put_velocity<S, kDense>(w, w.velocity, b, v);
    }
  }
  for_each_register<S, kDense>(t, w, [&](int at, Float push, Float factor) {
    Float v = Float::load(w.velocity + at) + push;
    if (t.has_drag) v = v * factor;
    v.store(w.velocity + at);
    v.store(w.impulse_part + at);
  });
}

template <class S, bool kDense>
void begin_substeps(const Tables& t, Work& w) {
  w.substep = 0;
  for_each_register<S, kDense>(t, w, [&](int at, Float, Float) {
    const Float v = Float::load(w.velocity + at);
    (v - Float::load(w.impulse_part + at)).store(w.impulse_part + at);
    v.store(w.warmed + at);
  });
}

template <class S, bool kDense>
void advance_displacement(const Tables& t, Work& w) {
  const Float h(t.h);
  for_each_register<S, kDense>(t, w, [&](int at, Float, Float) {
    fma(h, Float::load(w.velocity + at), Float::load(w.displacement + at))
        .store(w.displacement + at);
  });
}

template <class S, bool kDense>
void next_substep(const Tables& t, Work& w) {
  ++w.substep;
  for_each_register<S, kDense>(t, w, [&](int at, Float push, Float factor) {
    const Float v = Float::load(w.velocity + at);
    const Float part = Float::load(w.impulse_part + at) + (v - Float::load(w.warmed + at));
    Float next = v + push;
    if (t.has_drag) next = next * factor;
    next = next + part;
    part.store(w.impulse_part + at);
    next.store(w.velocity + at);
    next.store(w.warmed + at);
  });
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
