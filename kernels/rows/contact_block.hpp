// Contact block: the rows of one contact manifold, one manifold per lane. What the narrow phase
// finds and prepare() makes into Jacobians and effective masses; constant during a step but for the
// gaps and impulses.
//
// With A, B the bodies, n the unit normal from A to B, r the anchor of a point from the centre of
// mass:
//   J = [-n, -(rA x n), n, (rB x n)],  K = J M^-1 J^T,  effective mass m = 1 / K
// Friction acts at one point, the mean of the manifold's points: 1 (planar) or 2 (spatial)
// tangent rows, and for spatial manifolds of several points a twist row about n.
#pragma once

#include "kernels/collide/manifold.hpp"
#include "kernels/rows/side.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A side of a contact.
template <class S, int N, class Side>
struct ContactSide {};
template <class S, int N>
struct alignas(64) ContactSide<S, N, Free> : SideRows<S, Free> {
  Real arm[N][S::kAng][kLanes];  // r x n
  // Of the friction centre r, from the centre of mass: r x t in the plane, r in space.
  Real friction_arm[S::kAng][kLanes];
};

// Of blocks of two points, to solve both rows at once: 1 / (1 - K01^2 / (K00 K11)) and K01.
template <int N>
struct PairRows {};
template <>
struct PairRows<2> {
  Real gain[kLanes], coupling[kLanes];
};

struct alignas(64) BlockHeader : RowBodies {
  std::int32_t key[kLanes];
  std::uint32_t unsure;   // lanes in which nothing is expected to touch in this step
  std::uint32_t strikes;  // lanes in which an impact may be, or has reached it, in this step
  std::uint32_t struck;   // those in which it has had impulses in this substep
  bool apart;             // about other bodies than the block before it (apart.hpp)
};

// All but side A.
template <class S, int N>
struct alignas(64) ContactBlock : BlockHeader {
  static constexpr int kPoints = N;
  static constexpr bool kTwist = S::kDim == 3 && N > 1;
  static constexpr int kTangentMass = S::kTangents == 1 ? 1 : 3;
  static constexpr int kCross = N * (N - 1) / 2 == 0 ? 1 : N * (N - 1) / 2;

  alignas(64) Real normal[S::kDim][kLanes];
  Real tangent[S::kDim][kLanes];
  ContactSide<S, N, Free> b;
  Real cross_k[kCross][kLanes];  // off-diagonal entries of K, (0,1) (0,2) (0,3) (1,2) ...
  Real mass[N][kLanes];          // effective; 0 for points that are not there
  [[no_unique_address]] PairRows<N> pair;
  Real separation[N][kLanes];               // m, at the start of the pass
  Real gap[N][kLanes];                      // m, at the start of the substep
  Real impulse[N][kLanes];                  // N s, accumulated, >= 0
  Real tangent_mass[kTangentMass][kLanes];  // inverse of the 2x2, or 1x1
  Real slip_mass[kLanes];                   // in space, of what slips
  Real tangent_impulse[S::kTangents][kLanes];
  // m/s, by which forces on the bodies press them together in a substep; not of single points of
  // bodies that move.
  Real press[kLanes];
  Real friction[kLanes];
  Real twist_mass[kLanes], twist_impulse[kLanes];
  Real twist_arm[N][kLanes];  // distance of each point from the friction centre
  Real feature_x[N][kLanes], feature_y[N][kLanes];  // place on the reference feature, m
  Real code[kLanes];                                // which features touch
  std::uint32_t close[N];  // lanes in which a point is within the margin in this step
};
template <class S, int N, class A>
struct alignas(64) SidedBlock : ContactBlock<S, N> {
  ContactSide<S, N, A> a;
};

// Restitution rows, kept beside the blocks only when the plan has restitution.
template <class S, int N>
struct alignas(64) Bounce {
  Real restitution[kLanes];
  Real threshold[kLanes];   // m/s, slower approaches do not bounce
  Real impact[N][kLanes];   // approach speed at the moment of touch, m/s; 0: no impact
  Real carried[N][kLanes];  // impulse that the step began with
  Real total[N][kLanes];    // impulse over all substeps
  Real total_tangent[S::kTangents][kLanes];
  Real total_twist[kLanes];
  // The same before restitution, in steps that have any (energy.hpp).
  Real found[N][kLanes], found_tangent[S::kTangents][kLanes], found_twist[kLanes];
  Real reached[kLanes];  // m/s, of the impact that it takes part in
  // Of one sweep of restitution (solver/impacts.hpp).
  Real target[N][kLanes], played[N][kLanes];  // m/s to leave with; N s so far
  Real least[N][kLanes];                      // N s, of the friction that follows them
  Real approach[kLanes];                      // m/s, of the point that approaches fastest
  std::uint32_t participants, playing;        // lanes that take part in an impact; in a sweep
};

template <class Block>
MW_INLINE Block& block_at(const BlockList& list, int i) {
  return *reinterpret_cast<Block*>(list.blocks + static_cast<std::size_t>(i) * list.stride);
}
template <class S, int N>
MW_INLINE Bounce<S, N>& bounce_at(const BlockList& list, int i) {
  return *reinterpret_cast<Bounce<S, N>*>(list.bounces +
                                          static_cast<std::size_t>(i) * list.bounce_stride);
}

// Calls visit.operator()<points, side A>(list) for the lists in solver order.
template <class S, class Visit>
MW_INLINE void for_each_list(Work& w, Visit visit) {
  const auto list = [&](ListId id) -> BlockList& { return w.blocks[static_cast<int>(id)]; };
  visit.template operator()<S::kMulti, Free>(list(ListId::pair_multi));
  visit.template operator()<1, Free>(list(ListId::pair_single));
  visit.template operator()<S::kMulti, Fixed>(list(ListId::fixed_multi));
  visit.template operator()<1, Fixed>(list(ListId::fixed_single));
}
// Calls visit(block, index, list) for every block in solver order.
template <class S, class Visit>
MW_INLINE void for_each_block(Work& w, Visit visit) {
  for_each_list<S>(w, [&]<int N, class A>(BlockList& list) {
    for (int i = 0; i < list.count; ++i) visit(block_at<SidedBlock<S, N, A>>(list, i), i, list);
  });
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
