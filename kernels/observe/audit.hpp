// The audit of energy: does a world gain more of it in a step than its inputs give?
//
//   gain = E(end) - E(start) - given - driven
//   E       kinetic energy, potential energy of gravity, attractors and springs that are forces,
//   and
//           what joints hold that have come apart (kernels/joint/gap_energy.hpp)
//   given   at most by forces, controls and wind, |F| |v| dt with the speeds of both ends added,
//   and
//           by kinematic bodies that lift others
//   driven  by drives, springs and springy limits (kernels/joint/drive_work.hpp)
//
// A gain is compared with the kinetic energy at the start, what was given, and what is no sign of
// anything: bodies that leave an overlap at twice the push-out speed, and those that a kinematic
// body may hit. Shares of it add up from audit to audit and leak slowly, so that rounding never
// adds up; where the sum is 1 the world is flagged. Each world audits one step in audit_every of
// its own, whatever was written to it in between, so its flags depend on nothing but itself.
#pragma once

#include "kernels/flight/forces.hpp"
#include "kernels/observe/motion.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

inline constexpr int kFlaggedGain = 1024, kGainLeak = 8;  // the unit of gains is 1/1024
// Of the terms of a sum that ends as a small difference.
inline constexpr Real kAuditRounding = sizeof(Real) == 4 ? Real(2e-6) : Real(1e-14);

MW_INLINE std::uint32_t steps_since_audit(std::uint32_t status) {
  return status >> kernels::kAuditShift;
}
// Frozen worlds and those at rest take no steps.
MW_INLINE std::uint32_t audited_lanes(const Constants& t, const Group& g) {
  const std::uint32_t resting = t.has_sleep ? *g.resting : 0;
  return kAllLanes & ~(frozen_lanes(g) | resting);
}

inline int steps_ahead(const Constants& t, const Group& g) {
  const std::uint32_t lanes = audited_lanes(t, g);
  std::uint32_t most = 0;
  for (int l = 0; l < kLanes; ++l) {
    const std::uint32_t count = ((lanes >> l) & 1u) ? steps_since_audit(g.status[l]) : 0;
    most = count > most ? count : most;
  }
  // A snapshot of a batch that audits less often may have counted farther.
  const auto every = static_cast<std::uint32_t>(t.audit_every);
  return most < every ? static_cast<int>(every - most) : 1;
}

// Before gaps are looked at.
inline void clear_gaps(const Constants&, const Group&, kernels::Scratch* scratch) {
  Float(Real(0)).store(work_of(scratch).audit.sums + kGapEnergy * kLanes);
}

inline bool count_steps(const Constants& t, const Group& g, kernels::Scratch* scratch, int steps) {
  const auto more = static_cast<std::uint32_t>(steps) << kernels::kAuditShift;
  // Most often all worlds take the steps, and none is due.
  std::uint32_t any = 0, most = 0;
  for (int l = 0; l < kLanes; ++l) {
    any |= g.status[l];
    most = g.status[l] > most ? g.status[l] : most;
  }
  const bool all_step = (any & kernels::kFrozen) == 0 && !t.has_sleep;
  if (all_step && steps_since_audit(most) + static_cast<std::uint32_t>(steps) <
                      static_cast<std::uint32_t>(t.audit_every)) {
    for (int l = 0; l < kLanes; ++l) g.status[l] += more;
    return false;
  }
  const std::uint32_t lanes = audited_lanes(t, g);
  std::uint32_t due = 0;
  for (int l = 0; l < kLanes; ++l) {
    const std::uint32_t takes = (lanes >> l) & 1u;
    const std::uint32_t count =
        steps_since_audit(g.status[l]) + takes * static_cast<std::uint32_t>(steps);
    const bool now = takes != 0 && count >= static_cast<std::uint32_t>(t.audit_every);
    due |= static_cast<std::uint32_t>(now) << l;
    g.status[l] =
        (g.status[l] & ~kernels::kAuditCount) | ((now ? 0 : count) << kernels::kAuditShift);
  }
  work_of(scratch).audit.due = due;
  return due != 0;
}

// How fast kinematic bodies may move what is at x, squared, m^2/s^2.
template <class S>
MW_INLINE Float driver_speed2(const Constants& t, const Group& g, typename S::Vec x) {
  Float out(Real(0));
  for (int k = 0; k < t.bodies; ++k) {
    if (!t.body[k].kinematic) continue;
    const auto v = velocity_of<S>(t, g, k);
    const auto arm = x - load_as<typename S::Vec>(state_of(t, g, k, kState<S>.position));
    const Float speed = length_of(v.v) + length_of(v.w) * length_of(arm);
    out = fma(speed, speed, out);
  }
  return out;
}

struct EnergySums {
  Float energy, kinetic;  // J
  Float terms;            // sizes of what the energy is a sum of, J
  Float quiet;            // gains that say nothing, J
  Float power;            // of inputs at most, W
};

// Energy of the springs that the integrator takes for forces.
template <class S>
MW_INLINE Float elastic_energy(const Constants& t, const Group& g) {
  const Float zero(Real(0)), half(Real(0.5));
  Float out = zero;
  if constexpr (!std::is_same_v<S, Isotropic>) {  // plans with joints have tensors
    for_each_spring(t, g, [&](const JointPart& part, const Joint& constants, int) {
      const auto angular_velocity_of = [](int, const Motion<S>& m) { return m.spin; };
      const SpringNow<S> s = spring_now<S>(t, g, part, constants, g.state, angular_velocity_of);
      const Float stretch = part.kind == PartKind::point
                                ? length_of(s.gap)
                                : s.length - Float(constants.target_position);
      const Float energy = half * Float(constants.stiffness) * (stretch * stretch);
      out = out + select(s.active, energy, zero);
    });
  }
  return out;
}

// kQuiet: also what is compared with gains.
template <class S, bool kQuiet>
EnergySums sum_energy(const Constants& t, const Group& g) {
  using Vec = typename S::Vec;
  const Float zero(Real(0)), half(Real(0.5)), push(Real(2) * t.push_out_speed);
  bool driven = false;
  for (int b = 0; b < t.bodies; ++b) driven |= t.body[b].kinematic;
  EnergySums out{zero, zero, zero, zero, zero};
  for (int b = 0; b < t.bodies; ++b) {
    if (t.body[b].kinematic) continue;
    const BodyMass<S> m(g, b);
    const auto x = load_as<Vec>(state_of(t, g, b, kState<S>.position));
    const Velocity<S> v = velocity_of<S>(t, g, b);
    const Float weight = select(absent_lanes(g, b), zero, m.mass);
    const Mask there = zero < weight;
    typename S::Ang spin;
    Float spin_energy;
    spin_of<S>(t, g, b, m, v.w, spin, spin_energy);
    const Float kinetic = select(there, half * fma(weight, dot(v.v, v.v), spin_energy), zero);
    Float height = dot(m.pull, x);
    for (int i = 0; i < t.attractors; ++i) {
      const Attraction<S> at(g, b, i, x);
      height = fma(at.strength, at.nearness, height);
    }
    const Float potential = weight * height;
    out.kinetic = out.kinetic + kinetic;
    out.energy = out.energy + (kinetic - potential);
    out.terms = out.terms + (kinetic + abs(potential));
    const Float driver = driven ? driver_speed2<S>(t, g, x) : zero;
    if (driven) out.power = fma(weight * length_of(m.pull), sqrt(driver), out.power);  // lifts
    if constexpr (kQuiet) {
      Float quiet = fma(length_of(m.pull) * Float(t.step_dt), push, push * push);
      if (driven) quiet = fma(driver, Float(Real(4)), quiet);
      out.quiet = fma(weight, quiet, out.quiet);
    }
    if (!g.force && !is_thrust(t, b) && !t.has_drag) continue;
    const Load<S> load = load_of_body<S>(t, g, b, state_of(t, g, b, kState<S>.orientation));
    const auto wind = vector_of(S{}, constants_of_body(g, b).acceleration) - m.pull;
    const Float force = fma(length_of(wind), weight, length_of(load.force));
    const Float power = fma(force, length_of(v.v), length_of(load.torque) * length_of(v.w));
    out.power = out.power + select(there, power, zero);
  }
  const Float elastic = elastic_energy<S>(t, g);
  out.energy = out.energy + elastic, out.terms = out.terms + elastic;
  return out;
}

template <class S>
void begin_audit(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Real* sums = work_of(scratch).audit.sums;
  const EnergySums now = sum_energy<S, true>(t, g);
  const auto put = [&](AuditSum at, Float x) { x.store(sums + at * kLanes); };
  put(kEnergyBefore, now.energy + Float::load(sums + kGapEnergy * kLanes));
  put(kAuditScale, now.kinetic + now.quiet);
  put(kGiven, fma(now.power, Float(t.step_dt), now.terms * Float(kAuditRounding)));
  put(kDriven, Float(Real(0)));
}

template <class S>
void end_audit(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  const AuditWork& audit = work_of(scratch).audit;
  const auto get = [&](AuditSum at) { return Float::load(audit.sums + at * kLanes); };
  const Float zero(Real(0)), most(Real(4));
  const EnergySums now = sum_energy<S, false>(t, g);
  const Float given =
      get(kGiven) + fma(now.power, Float(t.step_dt), now.terms * Float(kAuditRounding));
  const Float energy = now.energy + get(kGapEnergy);
  const Float driven = get(kDriven), gain = (energy - get(kEnergyBefore)) - (given + driven);
  const Float share = gain / (get(kAuditScale) + (given + abs(driven)));
  std::uint32_t sums = 0;
  for (int l = 0; l < kLanes; ++l) sums |= g.status[l];
  const Mask gained = zero < share;
  if (!any(gained) && (sums & (kernels::kMaxGain << kernels::kGainShift)) == 0) return;
  alignas(64) Real unit[kLanes];
  // What is not a number is not in order either, so it is no gain.
  (select(gained, min(share, most), zero) * Float(Real(kFlaggedGain))).store(unit);
  const std::uint32_t lanes = audit.due & ~frozen_lanes(g);
  for (int l = 0; l < kLanes; ++l) {
    if (!((lanes >> l) & 1u)) continue;
    const int before = static_cast<int>((g.status[l] >> kernels::kGainShift) & kernels::kMaxGain);
    const int after = before + static_cast<int>(unit[l]) - kGainLeak;
    const int kept = after < 0 ? 0 : after > kFlaggedGain ? kFlaggedGain : after;
    g.status[l] = (g.status[l] & ~(kernels::kMaxGain << kernels::kGainShift)) |
                  (static_cast<std::uint32_t>(kept) << kernels::kGainShift);
    if (kept == kFlaggedGain) g.status[l] |= kernels::kDiverged;
  }
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
