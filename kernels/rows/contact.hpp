// contact: the solver passes over one block, written once for every space, point count and layout.
//
// Soft contact with substeps ("TGS soft", Catto). Normal row of a point with separation s:
//   lambda' = max(0, rigid - m bias - lost), rigid = lambda - m v, lost = i rigid
//   s > 0: bias = s / h, i = 0 (speculative)
//   s <= 0: bias = a r s, soft gains a, r, i with a = 1 - i (tables.hpp, Softness), but
//           m bias >= -max(m c, i lambda + m c / 8)
// with the push-out speed c, against fixed shapes up to twice as much where what they overlap is
// half of the length unit or deeper. What a load takes comes on top, so that no load is too much.
// A spring sags under what presses on it by F / (m w^2), however small the bodies. Against fixed
// shapes `lost` is no more than m times the speed fixed_leak under a load of gravity and forces,
// which sags by a hundredth of the length unit. Impacts lose as before: stiffer rows would throw
// light bodies from under heavy ones. The points of a manifold are solved in row space: their
// velocities are read once, each row's change updates the others through K's off-diagonal entries,
// and the sum is applied once. Friction: |tangent impulse| <= mu * sum(lambda), a circle; twist:
// |.| <= mu * sum(lambda_i arm_i).
#pragma once

#include "kernels/rows/blow.hpp"
#include "kernels/rows/solve_friction.hpp"
#include "kernels/rows/touched.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr Real kUnlimited = Real(1e30);       // N s
inline constexpr Real kTouching = Real(1.0 / 1024);  // of the margin: a gap that counts as none
inline constexpr Real kPushUnderLoad = Real(0.125);  // of c

inline constexpr Real kSlowBlow = Real(1.0 / 1024);  // of the least impact, in one

enum class Pass { warm_start, bias, relax };

// Adds to `gaps` how far each point has moved apart since the step began. From displacements:
// speeds seen in the middle of a pass are not those that moved the bodies.
template <bool kDense, class S, int N, class A>
MW_INLINE void moved_apart(const Work& w, const SidedBlock<S, N, A>& s, Float* gaps) {
  const auto moved = load_sides<S, A, kDense>(w.displacement, s);
  const Float along =
      dot(load_as<typename S::Vec>(s.normal[0]), relative_velocity(moved.a, moved.b));
  for (int i = 0; i < N; ++i) gaps[i] = normal_speed(s, i, moved, gaps[i] + along);
}

// The same in the lanes of an impact, from the separations at the start of the step.
template <bool kDense, class S, int N, class A>
__attribute__((noinline)) void find_gaps_of_struck(const Work& w, const SidedBlock<S, N, A>& s,
                                                   Float* gaps) {
  const Mask struck = mask_from_bits(s.struck);
  Float moved[N];
  for (int i = 0; i < N; ++i) moved[i] = Float::load(s.separation[i]);
  moved_apart<kDense>(w, s, moved);
  for (int i = 0; i < N; ++i) gaps[i] = select(struck, moved[i], gaps[i]);
}

// In the lanes that an impact may have reached in this step: does the block take a share of one?
// `d`: what its impulses change by; what it has not closed of a gap with `bias` follows in relax.
// Trees of joints share impacts out by themselves.
template <class S, int N>
struct Strike {
  Float impulse[N], d[N], bias[N];
};
template <class S, int N>
__attribute__((noinline)) std::uint32_t find_struck(const Work& w, const ContactBlock<S, N>& s,
                                                    const Strike<S, N>& of) {
  const Float zero(Real(0)), least = Float::load(w.strike_speed);
  Float beyond = zero;
  for (int i = 0; i < N; ++i) {
    const Float mass = Float::load(s.mass[i]);
    const Float ahead = select(zero < of.impulse[i], max(of.bias[i], zero), zero);
    beyond = max(fma(mass, ahead - least, abs(of.d[i])), beyond);
  }
  return s.strikes & bits(zero < beyond);
}
template <class S, int N, class A, class Velocities>
MW_INLINE void mark_struck(Work& w, SidedBlock<S, N, A>& s, const Float* impulse, const Float* d,
                           const Float* bias, const Velocities& v) {
  s.struck &= w.struck_before;
  if constexpr (requires { v.b.tree; }) return;
  if (s.strikes == 0) return;
  Strike<S, N> of;
  for (int i = 0; i < N; ++i) of.impulse[i] = impulse[i], of.d[i] = d[i], of.bias[i] = bias[i];
  s.struck |= find_struck(w, s, of);
  w.struck |= s.struck;
}

// `v`: the velocities of its sides, as they are loaded and as impulses change them.
template <bool kDense, Pass kPass, class S, int N, class A, class Velocities>
MW_INLINE void solve_rows(const Constants& t, Work& w, SidedBlock<S, N, A>& s, Velocities& v) {
  Float impulse[N], d[N];
  for (int i = 0; i < N; ++i) impulse[i] = Float::load(s.impulse[i]);

  if constexpr (kPass == Pass::warm_start) {
    apply_normal(s, impulse, v);
    if (t.has_friction) {
      Float f[2] = {Float::load(s.tangent_impulse[0]), Real(0)}, twist(Real(0));
      if constexpr (S::kTangents == 2) f[1] = Float::load(s.tangent_impulse[1]);
      if constexpr (ContactBlock<S, N>::kTwist) twist = Float::load(s.twist_impulse);
      apply_friction(s, f, twist, v);
    }
  } else {
    // In the bias pass friction steadies stacks, which stand on manifolds of several points.
    // Between moving bodies it comes first, so that it does not meet the speeds at which the pass
    // pushes them apart. On fixed shapes, which the next pass takes that back from at once, and of
    // links of trees it comes last, so that nothing slips where it is pushed.
    constexpr bool kSteadies = kPass == Pass::bias && N > 1;
    constexpr bool kFirst = kSteadies && A::kMoves;
    const bool steadies = kSteadies && t.has_friction && t.friction_in_bias;
    if constexpr (kFirst) {
      if (steadies) {
        if constexpr (requires { v.b.tree; }) {
          if ((s.mask & ~lanes_of_tree(v)) != 0) {
            solve_friction_of_lanes(s, !mask_from_bits(lanes_of_tree(v)), impulse, v);
          }
        } else {
          Float after[2], twist_after(Real(0));
          solve_friction(s, friction_budget(s, impulse), v, after, twist_after);
          store_friction(after, twist_after, s);
        }
      }
    }
    Float speed[N];
    normal_speeds(s, v, speed);
    const Float zero(Real(0)), inv_h(t.inv_h);
    // m/s; of rigid impulses what is given up; m/s of the push-out; N s, of relaxing rows at most.
    Float bias[N], keep[N], push_out[N], most[N];
    if constexpr (kPass == Pass::bias) {
      const auto& soft = A::kMoves ? t.soft_pair : t.soft_fixed;
      const Float rate(soft.bias_rate * soft.mass_scale), push(t.push_out_speed);
      Float gaps[N];
      for (int i = 0; i < N; ++i) gaps[i] = Float::load(s.separation[i]);
      if (w.substep > 0) {
        moved_apart<kDense>(w, s, gaps);
        for (int i = 0; i < N; ++i) gaps[i].store(s.gap[i]);
      }
      Float apart_by[N];
      for (int i = 0; i < N; ++i) apart_by[i] = gaps[i];
      if constexpr (N == 2) {
        // Hard rows leave gaps that are zero but for rounding: points with the same gap are both
        // hard or both soft.
        const Mask level = abs(gaps[0] - gaps[1]) < Float(t.margin * kTouching);
        const Float mean = (gaps[0] + gaps[1]) * Real(0.5);
        for (int i = 0; i < N; ++i) apart_by[i] = select(level, mean, gaps[i]);
      }
      for (int i = 0; i < N; ++i) {
        const Float gap = gaps[i];
        bias[i] = gap * select(zero < gap, inv_h, rate);
        keep[i] = select(zero < apart_by[i], zero, soft.impulse_scale);
        push_out[i] = A::kMoves ? push : clamp(gap * Float(-t.push_out_rate), push, push + push);
      }
      // Sweeps after an impact are hard, or heavy bodies would sink into light ones. Each of them
      // pushes overlaps out once more, hence the lower speed.
      if (w.settles) {
        for (int i = 0; i < N; ++i) {
          bias[i] = max(bias[i], push_out[i] * -kPushUnderLoad), keep[i] = zero;
        }
      }
    } else {
      // The substep has moved the bodies; now remove the speed that the push-out has added. A point
      // that is still apart gets no more impulse: whether it will touch is the next substep's, or
      // the next step's, business.
      const Float h(t.h), touch(t.margin * kTouching);
      Float gaps[N];
      for (int i = 0; i < N; ++i) gaps[i] = fma(h, speed[i], Float::load(s.gap[i]));
      // In an impact the bodies have got other speeds by now than those that moved them.
      if (s.struck != 0) {
        Float copy[N];  // so that these can stay in registers
        for (int i = 0; i < N; ++i) copy[i] = gaps[i];
        find_gaps_of_struck<kDense>(w, s, copy);
        for (int i = 0; i < N; ++i) gaps[i] = copy[i];
      }
      for (int i = 0; i < N; ++i) {
        const Float gap = gaps[i];
        bias[i] = max(gap, zero) * inv_h;
        most[i] = select(touch < gap, impulse[i], kUnlimited);
      }
    }
    // In the plane both points are solved at once below.
    if constexpr (N > 1 && S::kDim == 3) {
      Float comes = zero, goes = zero;
      for (int i = 0; i < N; ++i) {
        if constexpr (kPass == Pass::bias) most[i] = kUnlimited;
        const Float closing = speed[i] + max(bias[i], zero);
        comes = max(select(impulse[i] < most[i], -closing, zero), comes);
        goes = max(select(zero < impulse[i], closing, zero), goes);
      }
      Float least(t.blow_speed);
      if (const std::uint32_t struck = kPass == Pass::relax || w.settles ? s.struck : 0) {
        least = select(mask_from_bits(struck), Float::load(w.strike_speed) * kSlowBlow, least);
      }
      Mask blow = least < max(comes, goes);
      // Of links of trees, of which a joint takes a share, only loads that come at once are solved
      // so.
      if constexpr (requires { v.b.tree; }) {
        const Mask loads_only = mask_from_bits(lanes_of_tree(v));
        Mask load = mask_from_bits(0);
        if (kPass == Pass::bias && w.substep == 0) {
          const Float pressed = Float::load(s.press);
          load = (Float(t.blow_speed * Real(1.2)) < comes) & (comes < pressed + pressed);
        }
        blow = (blow & !loads_only) | (load & loads_only);
      }
      if (any(blow)) {
        const Blow<N> found = settle_blow(s, blow, bias, speed, impulse, most);
        const Velocities before = v;
        for (int i = 0; i < N; ++i) {
          impulse[i] = select(blow, impulse[i] + found.impulse[i], impulse[i]);
          speed[i] = select(blow, speed[i] + found.speed[i], speed[i]);
        }
        apply_normal(s, found.impulse, v);
        keep_other_lanes_of_sides(blow, before, v);
      }
    }
    // The impulse that point i wants at a speed along the normal; and within its bounds.
    const auto wanted = [&](int i, Float along) {
      const Float mass = Float::load(s.mass[i]);
      if constexpr (kPass == Pass::bias) {
        const Float rigid = fnma(mass, along, impulse[i]), cap = mass * push_out[i];
        const Float under_load = fma(cap, kPushUnderLoad, keep[i] * impulse[i]);
        const Float push = min(mass * -bias[i], max(cap, under_load));
        if constexpr (A::kMoves) return fnma(keep[i], rigid, rigid + push);
        const Float lost = keep[i] * rigid, pressed = mass * Float::load(s.press);
        const Float struck = fnma(keep[i], pressed + pressed, lost);
        return rigid + (push - min(lost, max(mass * Float(t.fixed_leak), struck)));
      } else {
        return fnma(mass, along + bias[i], impulse[i]);
      }
    };
    const auto bounded = [&](int i, Float x) {
      if constexpr (kPass == Pass::bias) return max(x, zero);
      return min(max(x, zero), most[i]);
    };
    if constexpr (N == 2) {
      // Each point solves its row as if the other had its share of the solution of both rows
      // without bounds. With bounds this is the solution, too, and what is symmetric stays so.
      const Float gain = Float::load(s.pair.gain), k = Float::load(s.pair.coupling);
      Float alone[2], total[2];
      for (int i = 0; i < 2; ++i) alone[i] = wanted(i, speed[i]) - impulse[i];
      for (int i = 0; i < 2; ++i) {
        const int other = 1 - i;
        const Float answer = fnma(Float::load(s.mass[other]), k * alone[i], alone[other]);
        const Float both = bounded(other, fma(gain, answer, impulse[other]));
        const Float along = fma(Float::load(s.cross_k[0]), both - impulse[other], speed[i]);
        total[i] = bounded(i, wanted(i, along));
      }
      for (int i = 0; i < N; ++i) {
        d[i] = total[i] - impulse[i];
        impulse[i] = total[i];
        total[i].store(s.impulse[i]);
      }
    } else {
      for (int i = 0; i < N; ++i) {
        const Float total = bounded(i, wanted(i, speed[i]));
        d[i] = total - impulse[i];
        impulse[i] = total;
        total.store(s.impulse[i]);
        couple_following(s, i, d[i], speed);
      }
    }
    if constexpr (kPass == Pass::bias) {
      mark_reached<S, A, kDense>(w, s);
      mark_struck(w, s, impulse, d, bias, v);
    }
    if ((kPass == Pass::relax && t.has_friction) || (!kFirst && steadies)) {
      Float after[2], twist_after(Real(0));
      apply_normal_with_friction(s, d, friction_budget(s, impulse), v, after, twist_after);
      store_friction(after, twist_after, s);
    } else {
      apply_normal(s, d, v);
    }
    if constexpr (kFirst && requires { v.b.tree; }) {
      if (steadies) solve_friction_of_lanes(s, mask_from_bits(lanes_of_tree(v)), impulse, v);
    }
  }
}

template <bool kDense, class S, int N, class A>
MW_INLINE RowVelocities<S, A, kDense> velocities_of(const Work& w, const SidedBlock<S, N, A>& s) {
  return {w, s};
}

// Not inlined: solver/strikes.hpp calls it for single blocks, too.
template <bool kDense, Pass kPass, class S, int N, class A>
__attribute__((noinline)) void solve_block(const Constants& t, Work& w, SidedBlock<S, N, A>& s) {
  auto v = velocities_of<kDense>(w, s);
  solve_rows<kDense, kPass>(t, w, s, v);
  v.store(w, s);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
