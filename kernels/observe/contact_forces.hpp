// Forces of contacts on bodies, from the impulses that a block had in a step.
#pragma once

#include "kernels/data/pair_keys.hpp"
#include "kernels/observe/observe.hpp"
#include "kernels/rows/contact_block.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, int N>
struct Totals;  // contacts.hpp

// Mean force and torque of a block over the step, on the bodies of its lanes. The torque is about
// the centre of mass, with the arms that the solver used.
template <class S, int N>
class ContactForces {
 public:
  ContactForces(const Constants& t, const ContactBlock<S, N>& s, const Totals<S, N>& total)
      : per_step_(Float(t.inv_h) / Float(static_cast<Real>(t.passes * t.substeps))),
        s_(s),
        total_(total) {
    const Vec normal = load_as<Vec>(s.normal[0]);
    force_ = fma(normal, total.sum, total.friction);
    if constexpr (S::kDim == 3) twist_ = normal * total.twist;
    has_friction_ = t.has_friction;
  }
  void add_to_b(const Constants& t, std::uint32_t lanes, Real* rows) const {
    put(t, lanes, false, force_, torque(s_.b), rows);
  }
  void add_to_a(const Constants& t, std::uint32_t lanes, Real* rows) const {
    const auto& sided = static_cast<const SidedBlock<S, N, Free>&>(s_);
    put(t, lanes, true, -force_, -torque(sided.a), rows);
  }

 private:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;

  MW_INLINE Ang torque(const ContactSide<S, N, Free>& side) const {
    Ang sum = zero_of<Ang>();
    for (int i = 0; i < N; ++i) {
      const Mask there = Float(Real(0)) < Float::load(s_.mass[i]);
      const Ang moment = load_as<Ang>(side.arm[i][0]) * total_.impulse[i];
      sum = sum + select(there, moment, zero_of<Ang>());
    }
    if (has_friction_) {
      if constexpr (S::kDim == 3) {
        sum = sum + (cross(load_as<Vec3>(side.friction_arm[0]), total_.friction) + twist_);
      } else {
        const Float along = dot(total_.friction, load_as<Vec>(s_.tangent[0]));
        sum = fma(load_as<Ang>(side.friction_arm[0]), along, sum);
      }
    }
    return sum;
  }
  void put(const Constants& t, std::uint32_t lanes, bool on_a, Vec force, Ang torque,
           Real* rows) const {
    constexpr int kRows = rows_of(Observer::link_forces);
    constexpr int kForce = row_of(Observed::external_force);
    constexpr int kTorque = row_of(Observed::external_torque) + (S::kDim == 2 ? 2 : 0);
    alignas(64) Real f[S::kDim][kLanes], n[S::kAng][kLanes];
    store(f[0], force * per_step_);
    store(n[0], torque * per_step_);
    for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
      const int l = __builtin_ctz(m);
      const kernels::PairOfKey pair = kernels::pair_of_key(t, s_.key[l]);
      const int body = t.collider_body[on_a ? pair.a : pair.b];
      Real* to = rows + body * kRows * kLanes + l;
      for (int c = 0; c < S::kDim; ++c) to[(kForce + c) * kLanes] += f[c][l];
      for (int c = 0; c < S::kAng; ++c) to[(kTorque + c) * kLanes] += n[c][l];
    }
  }

  Float per_step_;
  const ContactBlock<S, N>& s_;
  const Totals<S, N>& total_;
  Vec force_;
  Vec3 twist_ = zero_of<Vec3>();
  bool has_friction_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
