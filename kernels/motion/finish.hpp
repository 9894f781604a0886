// finish: checks the new state of every lane and commits it. A world whose new state is not
// finite or out of range keeps the state before the step, is flagged and stays frozen; the lanes
// beside it are committed as if it were not there.
#pragma once

#include "kernels/collide/cast.hpp"
#include "kernels/lane/finite.hpp"
#include "kernels/motion/substep_rotation.hpp"
#include "kernels/work/activity.hpp"
#include "kernels/work/half_turn.hpp"
#include "kernels/work/stages.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kMaxPosition = Real(1e10);  // m
inline constexpr Real kMaxSpeed = Real(1e5);      // m/s
inline constexpr Real kMaxSpin = Real(1e6);       // rad/s
inline constexpr Real kMaxSweep = Real(1e6);      // rad, in a step
inline constexpr Real kMinOrientation = Real(1e-3), kMaxOrientation = Real(1e3);

using kernels::kFrozen, kernels::kNonFinite, kernels::kOutOfBounds, kernels::kOutOfRange;
using kernels::kOverflow;

MW_INLINE Mask within_bounds(const Constants& t, Vec2 x) {
  return (Float(t.bounds_low[0]) <= x.x) & (x.x <= Float(t.bounds_high[0])) &
         (Float(t.bounds_low[1]) <= x.y) & (x.y <= Float(t.bounds_high[1]));
}
MW_INLINE Mask within_bounds(const Constants& t, Vec3 x) {
  return within_bounds(t, Vec2{x.x, x.y}) & (Float(t.bounds_low[2]) <= x.z) &
         (x.z <= Float(t.bounds_high[2]));
}

// Is a . a <= limit^2? NaN fails every comparison, so it is out of any range.
template <class A>
MW_INLINE Mask in_range(A a, Real limit) {
  return dot(a, a) <= Float(limit * limit);
}
struct LaneCheck {
  Mask good = mask_from_bits(kAllLanes);
  Mask finite = mask_from_bits(kAllLanes);

  // kIdle: some bodies do not take part; what they would do is not committed.
  template <class S, bool kIdle>
  MW_INLINE void add(const Constants& t, const Group& g, int body, const Velocity<S>& moved,
                     const Velocity<S>& v) {
    const auto x = load_as<typename S::Vec>(state_of(t, g, body, kState<S>.position)) + moved.v;
    Mask ok = in_range(x, kMaxPosition) & in_range(v.v, kMaxSpeed) & in_range(v.w, kMaxSpin);
    typename S::Orientation q;
    if (t.has_orientation) {  // only a written value can be bad: steps normalise
      q = load_as<typename S::Orientation>(state_of(t, g, body, kState<S>.orientation));
      // Push-out passes may rotate a body far that ends up slow.
      // One without a length has no direction to normalise.
      ok = ok & in_range(q, kMaxOrientation) & in_range(moved.w, kMaxSweep) &
           (Float(kMinOrientation * kMinOrientation) <= dot(q, q));
    }
    if constexpr (kIdle) ok = ok | mask_from_bits(idle_lanes(g, body) & kAllLanes);
    good = good & ok;
    if (!all(ok)) {
      Mask bounded = is_finite(x) & is_finite(v.v) & is_finite(v.w);
      if (t.has_orientation) bounded = bounded & is_finite(q) & is_finite(moved.w);
      if constexpr (kIdle) bounded = bounded | mask_from_bits(idle_lanes(g, body) & kAllLanes);
      finite = finite & bounded;
    }
  }

  // The orientation that an integrator ended with: one that spun out of all bounds has none.
  template <bool kIdle, class Q>
  MW_INLINE void add_end(const Group& g, int body, Q q, Mask free) {
    Mask ok = (Float(kMinOrientation * kMinOrientation) <= dot(q, q)) | !free;
    if constexpr (kIdle) ok = ok | mask_from_bits(idle_lanes(g, body) & kAllLanes);
    good = good & ok, finite = finite & ok;
  }
};

// Flags lanes that went bad in this step; returns those that may be committed.
inline std::uint32_t judge_lanes(const Group& g, const LaneCheck& check) {
  std::uint32_t commit = bits(check.good);
  const std::uint32_t finite = bits(check.finite);
  for (int l = 0; l < kLanes; ++l) {
    if (g.status[l] & kFrozen) {
      commit &= ~(1u << l);
    } else if (!((commit >> l) & 1u)) {
      g.status[l] |= ((finite >> l) & 1u) ? kOutOfRange : kNonFinite;
    }
  }
  return commit;
}

inline void flag_outside(const Group& g, std::uint32_t lanes) {
  for (int l = 0; lanes != 0 && l < kLanes; ++l) {
    if ((lanes >> l) & 1u) g.status[l] |= kOutOfBounds;
  }
}

// The first-order drift error of semi-implicit Euler: half of dt times the delta_v of a substep,
// and where drag changes it half a substep times what the velocity changed by.
template <class S, bool kDense>
MW_INLINE typename S::Vec drift_excess(const Constants& t, const Group& g, const Work& w,
                                       int body) {
  if (t.slows) {
    const auto before = load_as<typename S::Vec>(state_of(t, g, body, kState<S>.linear));
    const Velocity<S> now = get_velocity<S, kDense>(w, w.velocity, body);
    return (now.v - before) * Float(t.h * Real(0.5));
  }
  const Float scale(t.dt * Real(0.5));
  if (w.delta_v) return get_velocity<S, kDense>(w, w.delta_v, body).v * scale;
  const Real* p = t.delta_v_rows + body * S::kRow;
  typename S::Vec delta_v;
  delta_v.x = p[0], delta_v.y = p[1];
  if constexpr (S::kDim == 3) delta_v.z = p[2];
  return delta_v * scale;
}

// What may be written of a body: everything, the lanes of a mask, or those of them that are not
// idle. `of(body)` is the writer of that body.
struct AllLanes {
  MW_INLINE const AllLanes& of(int) const { return *this; }
  template <class T>
  MW_INLINE T operator()(const T& fresh, const Real*) const {
    return fresh;
  }
};
struct SomeLanes {
  Mask mask;
  MW_INLINE const SomeLanes& of(int) const { return *this; }
  template <class T>
  MW_INLINE T operator()(const T& fresh, const Real* old) const {
    return select(mask, fresh, load_as<T>(old));
  }
};

struct LiveLanes {
  const Group& g;
  std::uint32_t lanes;
  MW_INLINE SomeLanes of(int body) const { return {mask_from_bits(lanes & ~idle_lanes(g, body))}; }
};

// How bodies that nothing touched have moved: as the substeps say, or by another integrator, which
// then says where they are (kernels/flight/stages.hpp).
struct NoFlight {
  template <class Q>
  MW_INLINE Q orientation(int, Mask, Q swept) const {
    return swept;
  }
};
template <class Flight>
inline constexpr bool kFreeFlight = !std::is_same_v<Flight, NoFlight>;

// Orientations of bodies whose inertia is a scalar: by the angle that the substeps swept.
template <class S, class Keep, class Flight>
MW_INLINE void rotate_body(const Constants& t, const Group& g, int body, typename S::Ang angle,
                           Keep keep, Mask free, const Flight& flight) {
  Real* p = state_of(t, g, body, kState<S>.orientation);
  const auto swept = rotate_by(load_as<typename S::Orientation>(p), angle);
  store(p, keep(flight.orientation(body, free, swept), p));
}

// Orientations and angular velocities of kBodies bodies from `first` whose inertia is a tensor:
// bodies with joints are where the substeps have rotated them; of the others, free lanes tumble
// exactly, and lanes in contact rotate by the angle that the substeps swept.
template <bool kDense, int kBodies, class Keep, class Flight>
MW_INLINE void rotate_tensors(const Constants& t, const Group& g, Work& w, int first, Keep keep,
                              const Flight& flight) {
  const PrincipalInertia* tops[kBodies];
  Vec3 omega[kBodies], tumbled[kBodies];
  Quat q[kBodies], old[kBodies];
  for (int i = 0; i < kBodies; ++i) {
    tops[i] = &constants_of_body(g, first + i).principal;
    omega[i] = tumbled[i] = get_velocity<Tensor, kDense>(w, w.velocity, first + i).w;
    q[i] = old[i] = load_quat(state_of(t, g, first + i, kState<Tensor>.orientation));
  }
  std::uint32_t held_everywhere = kAllLanes;
  bool rotated[kBodies];  // by the substeps
  for (int i = 0; i < kBodies; ++i) {
    rotated[i] = t.body[first + i].rotated;
    if (!rotated[i]) held_everywhere &= w.touched[first + i];
  }
  if constexpr (kFreeFlight<Flight>) {
    for (int i = 0; i < kBodies; ++i) {
      const auto end = flight.of(first + i);
      tumbled[i] = end.spin, q[i] = end.q;
    }
  } else if (held_everywhere != kAllLanes) {
    rotate_free<kBodies>(tops, tumbled, q);
  }
  for (int i = 0; i < kBodies; ++i) {
    const std::uint32_t touched = w.touched[first + i];
    Vec3 spin = tumbled[i];
    if (rotated[i]) {
      const Quat by = rotation_of<Tensor>(w, first + i).q;
      const Mask held = mask_from_bits(kFreeFlight<Flight> ? touched : kAllLanes);
      q[i] = select(held, normalize(compose(by, old[i])), q[i]);
      spin = select(held, omega[i], spin);
    } else if (touched != 0) {
      const Mask held = mask_from_bits(touched);
      const Vec3 swept = get_velocity<Tensor, kDense>(w, w.displacement, first + i).w;
      q[i] = select(held, rotate_by(old[i], swept), q[i]);
      spin = select(held, omega[i], spin);
    }
    if (t.body[first + i].kinematic) spin = omega[i];
    Real* p = state_of(t, g, first + i, kState<Tensor>.orientation);
    const auto& keep_body = keep.of(first + i);
    store(p, keep_body(q[i], p));
    Real* p_angular = state_of(t, g, first + i, kState<Tensor>.angular);
    store(p_angular, keep_body(spin, p_angular));
  }
}

// The share of its step that a body may go before it hits what it is cast against.
template <class S, bool kDense, bool kIdle>
MW_INLINE Float cast_share(const Constants& t, const Group& g, const Work& w, int body,
                           typename S::Vec old, typename S::Vec step, typename S::Ang turn,
                           Mask free) {
  auto ahead = zero_of<typename S::Ang>();
  if (looks_ahead(t, w)) {
    ahead = half_turn(t, load_as<typename S::Ang>(state_of(t, g, body, kState<S>.angular)));
  }
  Float share(Real(1));
  if (t.cast) share = cast_against_fixed(t, g, w, body, old, step, turn, ahead, !free);
  if (t.cast_moving) {
    const auto moved = [&](int other) {
      const auto way = get_velocity<S, kDense>(w, w.displacement, other).v;
      if constexpr (!kIdle) return way;
      return select(mask_from_bits(idle_lanes(g, other) & kAllLanes), way - way, way);
    };
    share = min(share, cast_against_moving(t, g, w, body, old, step, turn, ahead, !free, moved));
  }
  return share;
}

template <class S, bool kDense, class Keep, class Flight>
void commit_lanes(const Constants& t, const Group& g, Work& w, std::uint32_t commit_bits, Keep keep,
                  const Flight& flight) {
  constexpr bool kIdle = std::is_same_v<Keep, LiveLanes>;
  Mask inside = mask_from_bits(kAllLanes);
  if (t.cast_moving) {
    find_swift(t, g, w, [&](int b) { return get_velocity<S, kDense>(w, w.displacement, b).v; });
  }
  for (int b = 0; b < t.bodies; ++b) {
    const auto& keep_body = keep.of(b);
    Velocity<S> v = get_velocity<S, kDense>(w, w.velocity, b);
    auto [way, angle] = get_velocity<S, kDense>(w, w.displacement, b);
    Mask free = mask_from_bits(~w.touched[b] & kAllLanes);
    Real* p = state_of(t, g, b, kState<S>.position);
    const auto old = load_as<typename S::Vec>(p);
    auto step = way;
    if constexpr (kFreeFlight<Flight>) {
      const auto end = flight.of(b);
      step = select(free, end.x - old, step);
      v = select(free, Velocity<S>{end.v, end.spin}, v);
    } else if (t.has_gravity || t.slows || w.delta_v) {
      step = select(free, step - drift_excess<S, kDense>(t, g, w, b), step);
    }
    if (t.cast || t.cast_moving) {
      auto turn = t.has_orientation ? angle : zero_of<typename S::Ang>();
      if constexpr (kFreeFlight<Flight>) turn = select(free, v.w * Float(t.dt), turn);
      const Float share = cast_share<S, kDense, kIdle>(t, g, w, b, old, step, turn, free);
      const Mask stops = share < Float(Real(1));
      if (any(stops)) {
        step = select(stops, step * share, step);
        angle = select(stops, turn * share, angle);
        // A stopped body keeps the pose of the cast, not that of free motion.
        free = free & !stops;
        if constexpr (std::is_same_v<S, Tensor>) {
          w.touched[b] |= bits(stops);
          put_velocity<S, kDense>(w, w.displacement, b, {way, angle});
          if (t.body[b].rotated) put_rotation(w, b, stops, angle);
          if constexpr (kFreeFlight<Flight>) put_velocity<S, kDense>(w, w.velocity, b, v);
        }
      }
    }
    const auto x = keep_body(old + step, p);
    store(p, x);
    if (t.has_bounds) {
      Mask in = within_bounds(t, x);
      if constexpr (kIdle) in = in | absent_lanes(g, b);
      inside = inside & in;
    }
    Real* p_linear = state_of(t, g, b, kState<S>.linear);
    store(p_linear, keep_body(v.v, p_linear));
    if constexpr (!std::is_same_v<S, Tensor>) {
      Real* p_angular = state_of(t, g, b, kState<S>.angular);
      store(p_angular, keep_body(v.w, p_angular));
      if (t.has_orientation) rotate_body<S>(t, g, b, angle, keep_body, free, flight);
    }
  }
  if constexpr (std::is_same_v<S, Tensor>) {
    int b = 0;
    for (; b + 1 < t.bodies; b += 2) rotate_tensors<kDense, 2>(t, g, w, b, keep, flight);
    if (b < t.bodies) rotate_tensors<kDense, 1>(t, g, w, b, keep, flight);
  }
  flag_outside(g, ~bits(inside) & commit_bits);
}

inline void report_overflow(const Group& g, const Work& w) {
  const std::uint32_t overflow = w.overflow & ~w.frozen;
  for (int l = 0; overflow != 0 && l < kLanes; ++l) {
    if ((overflow >> l) & 1u) g.status[l] |= kOverflow;
  }
}

template <class S, bool kDense, bool kIdle, class Flight>
std::uint32_t judge_bodies(const Constants& t, const Group& g, const Work& w,
                           const Flight& flight) {
  LaneCheck check;
  for (int b = 0; b < t.bodies; ++b) {
    Velocity<S> moved = get_velocity<S, kDense>(w, w.displacement, b);
    Velocity<S> v = get_velocity<S, kDense>(w, w.velocity, b);
    if constexpr (kFreeFlight<Flight>) {
      const auto end = flight.of(b);
      const Mask free = mask_from_bits(~w.touched[b] & kAllLanes);
      const auto from = load_as<typename S::Vec>(state_of(t, g, b, kState<S>.position));
      moved = select(free, Velocity<S>{end.x - from, zero_of<typename S::Ang>()}, moved);
      v = select(free, Velocity<S>{end.v, end.spin}, v);
      if (t.has_orientation) check.add_end<kIdle>(g, b, end.q, free);
    }
    check.add<S, kIdle>(t, g, b, moved, v);
  }
  return judge_lanes(g, check);
}

// Returns the lanes whose new state was committed.
template <class S, bool kDense, class Flight>
std::uint32_t leave_state(const Constants& t, const Group& g, Work& w, const Flight& flight) {
  if (has_idle_bodies(g)) {
    const std::uint32_t commit = judge_bodies<S, kDense, true>(t, g, w, flight);
    commit_lanes<S, kDense>(t, g, w, commit, LiveLanes{g, commit}, flight);
    return commit;
  }
  const std::uint32_t commit = judge_bodies<S, kDense, false>(t, g, w, flight);
  // The path without masks is for the default integrator: another one is compiled half as often.
  if constexpr (!kFreeFlight<Flight>) {
    if (commit == kAllLanes) {
      commit_lanes<S, kDense>(t, g, w, commit, AllLanes{}, flight);
      return commit;
    }
  }
  commit_lanes<S, kDense>(t, g, w, commit, SomeLanes{mask_from_bits(commit)}, flight);
  return commit;
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
