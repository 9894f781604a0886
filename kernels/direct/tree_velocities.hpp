// Velocities of the two sides of a contact of which some are of trees. Impulses on those act by the
// body's compliance, and by TreeResponse once the block is done.
#pragma once

#include "kernels/direct/response.hpp"
#include "kernels/rows/solve_friction.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// A side of a contact in the lanes in which it is of a tree.
template <class S>
struct TreeSide {
  std::uint32_t lanes = 0;
  ComplianceOf<S> compliance;
  Float inv_tree_mass;
};

// Velocity of a side, and the wrench that impulses have been about its centre of mass.
template <class S>
struct TreeVelocity : Velocity<S> {
  TreeSide<S> tree;
  WrenchOf<S> sum{zero_of<typename S::Ang>(), zero_of<typename S::Vec>()};

  // `free`: what the impulse makes of a body that moves freely.
  MW_INLINE void act(const WrenchOf<S>& p, const Velocity<S>& free) {
    if (tree.lanes == 0) {
      this->v = free.v, this->w = free.w;
    } else {
      act_on_tree(p, free);
    }
  }

 private:
  __attribute__((noinline)) void act_on_tree(const WrenchOf<S>& p, const Velocity<S>& free) {
    const Mask mask = mask_from_bits(tree.lanes);
    const TwistOf<S> change = mul(tree.compliance, p);
    this->v = select(mask, this->v + change.v, free.v);
    this->w = select(mask, this->w + change.w, free.w);
    sum = sum + p;
  }
};
template <class S>
MW_INLINE void keep_other_lanes(Mask lanes, const TreeVelocity<S>& before, TreeVelocity<S>& v) {
  keep_other_lanes(lanes, static_cast<const Velocity<S>&>(before), static_cast<Velocity<S>&>(v));
  v.sum.f = select(lanes, v.sum.f, before.sum.f);
  v.sum.n = select(lanes, v.sum.n, before.sum.n);
}
template <class S>
MW_INLINE void add_impulse(const SideRows<S, Free>& side, typename S::Vec p, typename S::Ang moment,
                           TreeVelocity<S>& v) {
  Velocity<S> free = v;
  add_impulse(side, p, moment, free);
  v.act({moment, p}, free);
}
template <class S>
MW_INLINE void add_impulse(const SideRows<S, Free>& side, typename S::Vec direction, Float amount,
                           typename S::Ang moment, TreeVelocity<S>& v) {
  Velocity<S> free = v;
  add_impulse(side, direction, amount, moment, free);
  v.act({moment, direction * amount}, free);
}
template <class S>
MW_INLINE void add_moment(const SideRows<S, Free>& side, typename S::Ang moment,
                          TreeVelocity<S>& v) {
  Velocity<S> free = v;
  add_moment(side, moment, free);
  v.act({moment, zero_of<typename S::Vec>()}, free);
}
template <class S>
MW_INLINE void take_moment(const SideRows<S, Free>& side, typename S::Ang moment,
                           TreeVelocity<S>& v) {
  Velocity<S> free = v;
  take_moment(side, moment, free);
  v.act({-moment, zero_of<typename S::Vec>()}, free);
}
template <class S>
MW_INLINE void take_impulse(const SideRows<S, Free>& side, typename S::Vec p,
                            typename S::Ang moment, TreeVelocity<S>& v) {
  Velocity<S> free = v;
  take_impulse(side, p, moment, free);
  v.act({-moment, -p}, free);
}
template <class S>
MW_INLINE void take_impulse(const SideRows<S, Free>& side, typename S::Vec direction, Float amount,
                            typename S::Ang moment, TreeVelocity<S>& v) {
  Velocity<S> free = v;
  take_impulse(side, direction, amount, moment, free);
  v.act({-moment, -(direction * amount)}, free);
}

// Calls visit(body, lanes) for the bodies at one end of a block.
template <class S, bool kDense, class Visit>
MW_INLINE void for_each_body(const Work& w, const std::int32_t* offset, int body,
                             std::uint32_t lanes, Visit visit) {
  if constexpr (kDense) {
    if (lanes != 0) visit(body, lanes);
  } else {
    while (lanes != 0) {
      const auto body_of = [&](int lane) {
        return (offset[lane] - w.velocity_base[lane]) / S::kRow;
      };
      const int first = body_of(__builtin_ctz(lanes));
      std::uint32_t same = 0;
      for (std::uint32_t m = lanes; m != 0; m &= m - 1) {
        const int lane = __builtin_ctz(m);
        if (body_of(lane) == first) same |= 1u << lane;
      }
      visit(first, same);
      lanes &= ~same;
    }
  }
}

// What the end of a block knows of its tree.
template <class S, bool kDense>
MW_INLINE TreeSide<S> load_tree_side(const Work& w, const std::int32_t* offset, int body,
                                     std::uint32_t active) {
  TreeSide<S> out{};
  for_each_body<S, kDense>(w, offset, body, active, [&](int of, std::uint32_t in) {
    const std::uint32_t lanes = in & w.direct.held[of];
    if (lanes == 0) return;
    const Real* from = w.direct.compliance + of * kComplianceRowsOf<S> * kLanes;
    const auto c = load_as<ComplianceOf<S>>(from);
    const Float inv_mass = Float::load(w.direct.inv_tree_mass + of * kLanes);
    const Mask mask = mask_from_bits(lanes);
    out.compliance = out.lanes == 0 ? c : select(mask, c, out.compliance);
    out.inv_tree_mass = out.lanes == 0 ? inv_mass : select(mask, inv_mass, out.inv_tree_mass);
    out.lanes |= lanes;
  });
  return out;
}

template <class S, class A, bool kDense>
class TreeVelocities {
 public:
  static constexpr bool kIsDense = kDense;
  std::conditional_t<A::kMoves, TreeVelocity<S>, Still> a;
  TreeVelocity<S> b;

  MW_INLINE TreeVelocities(const TreeResponse<S, kDense>& response, Work& w, const RowBodies& s)
      : response_(response), w_(w) {
    load(s.offset_b, s.body_b, s.mask, b);
    if constexpr (A::kMoves) load(s.offset_a, s.body_a, s.mask, a);
  }
  template <class Block>
  MW_INLINE void store(const Block& s) const {
    store(s.b, s.offset_b, s.body_b, s.mask, b);
    if constexpr (A::kMoves) store(s.a, s.offset_a, s.body_a, s.mask, a);
  }

 private:
  // Not inlined: as parts of every pass over every kind of block, what acts on trees, this and the
  // next were a fifth of the code of trees.
  __attribute__((noinline)) void load(const std::int32_t* offset, int body, std::uint32_t lanes,
                                      TreeVelocity<S>& to) const {
    static_cast<Velocity<S>&>(to) = load_velocity<S, kDense>(w_.velocity, offset, body);
    to.tree = load_tree_side<S, kDense>(w_, offset, body, lanes);
    for_each_body<S, kDense>(w_, offset, body, to.tree.lanes, [&](int of, std::uint32_t in) {
      const Velocity<S> v = response_.velocity_of(of), own = to;
      static_cast<Velocity<S>&>(to) = select(mask_from_bits(in), v, own);
    });
  }
  // In a tree's lanes the next substep begins with what impulses do to the bodies alone: the
  // tree's solve makes of it what the tree does.
  __attribute__((noinline)) void store(const SideRows<S, Free>& rows, const std::int32_t* offset,
                                       int body, std::uint32_t lanes,
                                       const TreeVelocity<S>& v) const {
    const std::uint32_t of_tree = v.tree.lanes;
    if (of_tree == 0) return store_velocity<S, kDense>(w_.velocity, offset, body, lanes, v);
    const Mask mask = mask_from_bits(of_tree);
    const Velocity<S> old = load_velocity<S, kDense>(w_.velocity, offset, body);
    store_velocity<S, kDense>(w_.velocity, offset, body, lanes,
                              select(mask, old, static_cast<const Velocity<S>&>(v)));
    const Velocity<S> before = load_velocity<S, kDense>(w_.impulse_part, offset, body);
    Velocity<S> carried = before;
    add_impulse(rows, v.sum.f, v.sum.n, carried);
    store_velocity<S, kDense>(w_.impulse_part, offset, body, lanes, select(mask, carried, before));
    for_each_body<S, kDense>(w_, offset, body, of_tree & bits(is_there(v.sum)),
                             [&](int of, std::uint32_t in) { response_.push(of, v.sum, in); });
  }
  static MW_INLINE Mask is_there(const WrenchOf<S>& p) {
    return Float(Real(0)) < dot(p.f, p.f) + dot(p.n, p.n);
  }

  const TreeResponse<S, kDense>& response_;
  Work& w_;
};

template <class S, class A, bool kDense>
MW_INLINE std::uint32_t lanes_of_tree(const TreeVelocities<S, A, kDense>& v) {
  std::uint32_t lanes = v.b.tree.lanes;
  if constexpr (A::kMoves) lanes |= v.a.tree.lanes;
  return lanes;
}

// Lanes without a tree get the bits of blocks without one.
template <int N, class A, bool kDense>
MW_INLINE void apply_normal_with_friction(const SidedBlock<Planar, N, A>& s, const Float* d,
                                          const FrictionBudget& budget,
                                          TreeVelocities<Planar, A, kDense>& v, Float* after,
                                          Float& twist_after) {
  const std::uint32_t lanes = lanes_of_tree(v);
  SideVelocities<Planar, A> free;
  free.b = v.b;
  if constexpr (A::kMoves) free.a = v.a;
  Float after_free[2];
  apply_normal_with_friction(s, d, budget, free, after_free);
  apply_normal(s, d, v);
  solve_friction(s, budget, v, after, twist_after);
  const Mask tree = mask_from_bits(lanes);
  const auto put = [&](const Velocity<Planar>& of_free, TreeVelocity<Planar>& to) {
    static_cast<Velocity<Planar>&>(to) = select(tree, Velocity<Planar>(to), of_free);
  };
  put(free.b, v.b);
  if constexpr (A::kMoves) put(free.a, v.a);
  after[0] = select(tree, after[0], after_free[0]);
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
