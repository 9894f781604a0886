// How far the solver was from done: what one more of its sweeps would change in the velocities of
// bodies. `save_rows` keeps the rows and velocities as the step left them, the pipeline sweeps once
// more, `compare` takes the difference and restores them.
#pragma once

#include "kernels/motion/integrate.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/work/activity.hpp"
#include "kernels/work/solver_tables.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Calls visit(begin, bytes) for each array that a sweep writes to, but velocities.
template <class Visit>
void for_each_row_array(const Constants& t, const Work& w, bool all, Visit visit) {
  const auto bytes = [](int count, std::size_t each) {
    return static_cast<std::size_t>(count) * each;
  };
  if (t.has_joints) {
    visit(w.parts,
          bytes(t.parts, t.dimension == kernels::Dimension::planar ? part_bytes(Planar{})
                                                                   : part_bytes(Tensor{})));
  }
  if (t.has_contacts) {
    visit(reinterpret_cast<unsigned char*>(w.touched), bytes(t.bodies + 1, sizeof *w.touched));
  }
  for (int l = 0; t.has_contacts && l < kLists; ++l) {
    const BlockList& list = w.blocks[l];
    const int count = all ? list.max_blocks : list.count;
    visit(list.blocks, bytes(count, list.stride));
    if (t.has_restitution) visit(list.bounces, bytes(count, list.bounce_stride));
  }
}

inline std::size_t velocity_reals(const Constants& t, const Work& w) {
  return static_cast<std::size_t>(w.rows_per_lane * kernels::velocity_row_size(t.dimension) *
                                  kLanes);
}

inline std::size_t saved_bytes(const Constants& t, kernels::Scratch* scratch) {
  const Work& w = work_of(scratch);
  std::size_t out = velocity_reals(t, w) * sizeof(Real);
  for_each_row_array(t, w, true, [&](unsigned char*, std::size_t bytes) { out += bytes; });
  return out;
}

inline void copy_bytes(const unsigned char* from, unsigned char* to, std::size_t bytes) {
  for (std::size_t i = 0; i < bytes; ++i) to[i] = from[i];
}

inline void save_rows(const Constants& t, const Group&, kernels::Scratch* scratch,
                      const ObserverView& o) {
  const Work& w = work_of(scratch);
  Real* velocity = reinterpret_cast<Real*>(o.saved);
  const std::size_t reals = velocity_reals(t, w);
  for (std::size_t i = 0; i < reals; ++i) velocity[i] = w.velocity[i];
  unsigned char* to = o.saved + reals * sizeof(Real);
  for_each_row_array(t, w, false, [&](unsigned char* from, std::size_t bytes) {
    copy_bytes(from, to, bytes);
    to += bytes;
  });
}

MW_INLINE Float largest(Float a) { return abs(a); }
MW_INLINE Float largest(Vec2 a) { return max(abs(a.x), abs(a.y)); }
MW_INLINE Float largest(Vec3 a) { return max(max(abs(a.x), abs(a.y)), abs(a.z)); }

template <class S, bool kDense>
void find_change(const Constants& t, const Work& w, const Real* before, Float& speed, Float& spin) {
  for (int b = 0; b < t.bodies; ++b) {
    const Velocity<S> now = get_velocity<S, kDense>(w, w.velocity, b),
                      was = get_velocity<S, kDense>(w, before, b);
    speed = max(speed, largest(now.v - was.v));
    spin = max(spin, largest(now.w - was.w));
  }
}

template <class S>
void compare(const Constants& t, const Group& g, kernels::Scratch* scratch, const ObserverView& o) {
  Work& w = work_of(scratch);
  const Real* velocity = reinterpret_cast<const Real*>(o.saved);
  Float speed(Real(0)), spin(Real(0));
  if (w.dense || !t.has_contacts) {
    find_change<S, true>(t, w, velocity, speed, spin);
  } else {
    find_change<S, false>(t, w, velocity, speed, spin);
  }
  const Mask live = mask_from_bits(~frozen_lanes(g) & kAllLanes);
  Real* rows = rows_for(o, Observer::residual);
  select(live, speed, Float(Real(0))).store(rows);
  select(live, spin, Float(Real(0))).store(rows + kLanes);
  const std::size_t reals = velocity_reals(t, w);
  for (std::size_t i = 0; i < reals; ++i) w.velocity[i] = velocity[i];
  const unsigned char* from = o.saved + reals * sizeof(Real);
  for_each_row_array(t, w, false, [&](unsigned char* to, std::size_t bytes) {
    copy_bytes(from, to, bytes);
    from += bytes;
  });
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
