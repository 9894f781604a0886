// Effective masses of contacts by how their bodies give way as parts of trees, and so the softness
// that comes with them: a load on light legs rests on contacts that are as stiff as it is heavy.
#pragma once

#include "kernels/direct/tree_velocities.hpp"
#include "kernels/rows/contact_block.hpp"
#include "kernels/rows/couple.hpp"
#include "kernels/rows/resistance.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// 1/kg, of the trees of bodies.
inline void find_tree_masses(const Constants& t, const Group& g, const Work& w) {
  const Float one(Real(1));
  const auto row = [&](int b) { return w.direct.inv_tree_mass + b * kLanes; };
  for_each_tree_body(t,
                     [&](int b) { (one / Float(constants_of_body(g, b).inv_mass)).store(row(b)); });
  for (int i = t.joint_trees.edges - 1; i >= 0; --i) {
    const TreeEdge& edge = t.joint_trees.edge[i];
    if (!edge.prescribed) add_to(row(edge.parent), 0, Float::load(row(edge.child)));
  }
  const auto invert = [&](int b) { (one / Float::load(row(b))).store(row(b)); };
  for (int i = 0; i < t.joint_trees.roots; ++i) invert(t.joint_trees.root[i]);
  for (int i = 0; i < t.joint_trees.edges; ++i) {
    const TreeEdge& edge = t.joint_trees.edge[i];
    if (edge.prescribed) {
      invert(edge.child);
    } else {
      Float::load(row(edge.parent)).store(row(edge.child));
    }
  }
}

// What a wrench does to a side.
template <class S>
MW_INLINE TwistOf<S> response_of(const SideRows<S, Free>& rows, const TreeSide<S>& side,
                                 const WrenchOf<S>& p) {
  const TwistOf<S> free{apply(inertia_of<S>(rows), p.n), p.f * Float::load(rows.inv_mass)};
  if (side.lanes == 0) return free;
  return select(mask_from_bits(side.lanes), mul(side.compliance, p), free);
}
template <class S>
MW_INLINE Float inv_mass_of(const SideRows<S, Free>& rows, const TreeSide<S>& side) {
  const Float alone = Float::load(rows.inv_mass);
  return side.lanes == 0 ? alone : select(mask_from_bits(side.lanes), side.inv_tree_mass, alone);
}

// Effective masses of a block in some lanes, by how its sides give way. A joint may hold a body
// wholly along a normal, and rounding leave anything: no contact is heavier than its trees.
template <class S, int N, class A>
void put_masses(const Constants& t, SidedBlock<S, N, A>& s, const TreeSide<S>& of_a,
                const TreeSide<S>& of_b, std::uint32_t lanes) {
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  const Float zero(Real(0));
  const Mask changes = mask_from_bits(lanes);
  const auto put = [&](Float x, Real* to) { select(changes, x, Float::load(to)).store(to); };
  // Speed along the second of unit impulses along the first.
  const auto coupling = [&](const auto& wrench, int i, int j) {
    Float k = dot(response_of(s.b, of_b, wrench(s.b, i)), wrench(s.b, j));
    if constexpr (A::kMoves) k = k + dot(response_of(s.a, of_a, wrench(s.a, i)), wrench(s.a, j));
    return k;
  };

  Float least = inv_mass_of(s.b, of_b);
  if constexpr (A::kMoves) least = least + inv_mass_of(s.a, of_a);

  const Vec n = load_as<Vec>(s.normal[0]);
  const auto normal = [&](const ContactSide<S, N, Free>& side, int i) {
    return WrenchOf<S>{load_as<Ang>(side.arm[i][0]), n};
  };
  for (int i = 0, at = 0; i < N; ++i) {
    const Float mass = Float::load(s.mass[i]);
    put(select(zero < mass, inverse_or_zero(max(coupling(normal, i, i), least)), zero), s.mass[i]);
    for (int j = i + 1; j < N; ++j) put(coupling(normal, i, j), s.cross_k[at++]);
  }
  if constexpr (N == 2) put_pair(s);
  if (!t.has_friction) return;
  const Vec first = load_as<Vec>(s.tangent[0]);
  const auto tangent = [&](const ContactSide<S, N, Free>& side, int i) {
    const auto arm = load_as<Ang>(side.friction_arm[0]);
    if constexpr (S::kDim == 2) {
      return WrenchOf<S>{arm, first};
    } else {
      const Vec along = i == 1 ? cross(n, first) : first;
      return WrenchOf<S>{cross(arm, along), along};
    }
  };
  const Float k11 = max(coupling(tangent, 0, 0), least);
  if constexpr (S::kTangents == 1) {
    put(inverse_or_zero(k11), s.tangent_mass[0]);
  } else {
    const Float k12 = coupling(tangent, 0, 1), k22 = max(coupling(tangent, 1, 1), least);
    const Float scale = inverse_or_zero(fms(k11, k22, k12 * k12));
    put(k22 * scale, s.tangent_mass[0]), put(-(k12 * scale), s.tangent_mass[1]);
    put(k11 * scale, s.tangent_mass[2]);
    put(Float(Real(2)) * inverse_or_zero(k11 + k22), s.slip_mass);
    if constexpr (ContactBlock<S, N>::kTwist) {
      const auto about = [&](const auto&, int) { return WrenchOf<S>{n, zero_of<Vec>()}; };
      Float arm = zero;
      for (int i = 0; i < N; ++i) arm = max(arm, Float::load(s.twist_arm[i]));
      // What turns it turns the farthest point by as much as it would be pushed.
      const Float k = max(coupling(about, 0, 0), least * inverse_or_zero(arm * arm));
      put(inverse_or_zero(k), s.twist_mass);
    }
  }
}

// The same of its resistance. A joint may hold a body wholly against turning, and rounding leave
// anything: a share of what the body's tree would do at the body's radius of gyration bounds it.
template <class S, int N, class A>
void put_turning(const SidedBlock<S, N, A>& s, const TreeSide<S>& of_a, const TreeSide<S>& of_b,
                 std::uint32_t lanes, Resistance<S>& r) {
  using Ang = typename S::Ang;
  constexpr Real kShare = Real(1.0 / 16);
  const auto give = [](const SideRows<S, Free>& rows, const TreeSide<S>& side, Ang p, Ang q) {
    const WrenchOf<S> about_p{p, zero_of<typename S::Vec>()}, about_q{q, about_p.f};
    const Float k = dot(response_of(rows, side, about_p), about_q);
    if (side.lanes == 0) return k;
    const Float alone = turn(p, inertia_of<S>(rows), q);
    const Float lighter = side.inv_tree_mass * inverse_or_zero(Float::load(rows.inv_mass));
    return select(mask_from_bits(side.lanes), fma(alone * kShare, lighter, k), k);
  };
  const auto normal = load_as<typename S::Vec>(s.normal[0]);
  const TurningMasses m = turning_masses(r, normal, [&](Ang p, Ang q) {
    Float k = give(s.b, of_b, p, q);
    if constexpr (A::kMoves) k = k + give(s.a, of_a, p, q);
    return k;
  });
  put_masses(m, mask_from_bits(lanes), r);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
