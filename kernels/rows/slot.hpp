// Slot: the rows of one contact manifold, one manifold per lane. What the narrow phase finds and
// prepare() turns into Jacobians and effective masses; constant during a step but for the
// gaps and impulses.
//
// With A, B the bodies (A absent for fixed shapes), n the unit normal from A to B, r the anchor of
// a point from the centre of mass:
//   J = [-n, -(rA x n), n, (rB x n)],  K = J M^-1 J^T,  effective mass m = 1 / K
// Friction acts at one point, the mean of the manifold's points: 1 (planar) or 2 (spatial)
// tangent rows, and for spatial manifolds of several points a twist row about n.
#pragma once

#include <type_traits>

#include "kernels/collide/manifold.hpp"
#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// Whose velocities rows act on.
struct alignas(64) SlotBodies {
  std::int32_t offset_a[kLanes], offset_b[kLanes];  // velocity rows; dummy in inactive lanes
  std::uint32_t mask;                               // active lanes
  std::int32_t body_a, body_b;                      // dense layout: the bodies of every lane
};
struct alignas(64) SlotHeader : SlotBodies {
  std::int32_t key[kLanes];
};

template <class S, int N>
struct alignas(64) Slot : SlotHeader {
  static constexpr int kPoints = N;
  static constexpr bool kTwist = S::kDim == 3 && N > 1;
  static constexpr int kTangentMass = S::kTangents == 1 ? 1 : 3;
  static constexpr int kCross = N * (N - 1) / 2 == 0 ? 1 : N * (N - 1) / 2;

  alignas(64) Real normal[S::kDim][kLanes];
  Real tangent[S::kDim][kLanes];
  Real inv_mass_a[kLanes], inv_mass_b[kLanes];
  Real inertia_a[S::kInertia][kLanes], inertia_b[S::kInertia][kLanes];  // inverse
  Real arm_a[N][S::kAng][kLanes], arm_b[N][S::kAng][kLanes];            // r x n
  Real cross_k[kCross][kLanes];  // off-diagonal entries of K, (0,1) (0,2) (0,3) (1,2) ...
  Real mass[N][kLanes];          // effective; 0 for points that are not there
  Real separation[N][kLanes];    // m, at the start of the step
  Real gap[N][kLanes];           // m, at the start of the substep
  Real impulse[N][kLanes];       // N s, accumulated, >= 0
  Real centre_a[S::kDim][kLanes], centre_b[S::kDim][kLanes];  // friction centre from the bodies
  Real tangent_mass[kTangentMass][kLanes];                    // inverse of the 2x2, or 1x1
  Real tangent_impulse[S::kTangents][kLanes];
  Real friction[kLanes];
  Real twist_mass[kLanes], twist_impulse[kLanes];
  Real twist_arm[N][kLanes];  // distance of each point from the friction centre
  Real feature_x[N][kLanes], feature_y[N][kLanes];  // place on the reference feature, m
  Real code[kLanes];                                // which features touch
};

// Restitution rows, kept beside the slots only when the plan has restitution.
template <class S, int N>
struct alignas(64) Bounce {
  Real restitution[kLanes];
  Real impact[N][kLanes];   // approach speed at the moment of touch, m/s; 0: no impact
  Real carried[N][kLanes];  // impulse that the step began with
  Real total[N][kLanes];    // impulse over all substeps
  Real total_tangent[S::kTangents][kLanes];
  Real total_twist[kLanes];
  // The same before restitution, in steps that have any (energy.hpp).
  Real found[N][kLanes], found_tangent[S::kTangents][kLanes], found_twist[kLanes];
  std::uint32_t participants;  // lanes that took part in an impact
};

template <class S, int N>
MW_INLINE Slot<S, N>& slot_at(const SlotList& list, int i) {
  return *reinterpret_cast<Slot<S, N>*>(list.slots + static_cast<std::size_t>(i) * list.stride);
}
template <class S, int N>
MW_INLINE Bounce<S, N>& bounce_at(const SlotList& list, int i) {
  return *reinterpret_cast<Bounce<S, N>*>(list.bounces +
                                          static_cast<std::size_t>(i) * list.bounce_stride);
}

// Calls visit(slot, index, list, pair?) for every slot in solver order.
template <class S, class Visit>
MW_INLINE void for_each_slot(Work& w, Visit visit) {
  constexpr std::integral_constant<bool, true> kMoves{};
  constexpr std::integral_constant<bool, false> kFixed{};
  SlotList& l0 = w.slots[static_cast<int>(ListId::pair_multi)];
  for (int i = 0; i < l0.count; ++i) visit(slot_at<S, S::kMulti>(l0, i), i, l0, kMoves);
  SlotList& l1 = w.slots[static_cast<int>(ListId::pair_single)];
  for (int i = 0; i < l1.count; ++i) visit(slot_at<S, 1>(l1, i), i, l1, kMoves);
  SlotList& l2 = w.slots[static_cast<int>(ListId::fixed_multi)];
  for (int i = 0; i < l2.count; ++i) visit(slot_at<S, S::kMulti>(l2, i), i, l2, kFixed);
  SlotList& l3 = w.slots[static_cast<int>(ListId::fixed_single)];
  for (int i = 0; i < l3.count; ++i) visit(slot_at<S, 1>(l3, i), i, l3, kFixed);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
