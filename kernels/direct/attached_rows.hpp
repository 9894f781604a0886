// Rows of joints that act on bodies of trees without being part of them: rods, ropes, springs,
// pulleys and targets. Like contacts (response.hpp) they are solved one after the other, between
// two solves of the trees. With W the inverse of a tree's inertia and W0 that of free bodies, the
// effective mass of a row J is 1 / (J (W + floor W0) J'), both its ends included. The floor bounds
// it where the tree holds a row fully and W has only rounding. Lanes in which no tree moves a body
// compute what sweeps compute.
#pragma once

#include "kernels/direct/loops.hpp"
#include "kernels/direct/response.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
class AttachedRows {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  AttachedRows(const Constants& t, const Group& g, Work& w) : t_(t), g_(g), w_(w) {}

  // visit(body, lanes) for the bodies that they act on.
  template <class Visit>
  MW_INLINE void for_each_end(Visit visit) const {
    for_each([&](auto& s, const JointPart&, const Joint&) {
      if (s.body_a < t_.bodies) visit(s.body_a, s.mask);
      visit(s.body_b, s.mask);
    });
  }

  // Computes effective masses. The compliances of touched bodies must be known.
  void weigh(const TreeFactors<S>& factors) const {
    const TreePaths<S, true> paths(t_, w_, factors);
    paths.open();
    for_each([&](auto& s, const JointPart&, const Joint&) {
      const std::uint32_t trees = lanes_of(s.body_a, s.mask) | lanes_of(s.body_b, s.mask);
      if (trees != 0) weigh_part(paths, mask_from_bits(trees), s);
    });
  }

  // Gauss-Seidel; a single row is repeated once to remove the error of the floor.
  template <Pass kPass>
  void solve(const TreeResponse<S, kDense>& response) const {
    constexpr int kMostSweeps = 4;
    const int rows = t_.joint_trees.attached, sweeps = rows < kMostSweeps ? rows + 1 : kMostSweeps;
    for (int i = 0; i < sweeps; ++i) {
      for_each([&](auto& s, const JointPart& part, const Joint& constants) {
        solve_part<kPass>(response, part, constants, s);
      });
    }
  }

 private:
  // visit(rows, part, its constants) for each that acts in some lane.
  template <class Visit>
  MW_INLINE void for_each(Visit visit) const {
    for (int i = 0; i < t_.parts; ++i) {
      const JointPart& part = t_.part[i];
      if (!part.attached) continue;
      const auto look = [&](auto& s) {
        if (s.mask != 0) visit(s, part, constants_of_part(g_, i));
      };
      part.kind == PartKind::point ? look(part_rows<S, PointRows<S>>(w_, i))
                                   : look(part_rows<S, Row<S>>(w_, i));
    }
  }
  struct SideTwists {
    TwistOf<S> a, b;
  };

  // Of `lanes` those in which a tree moves a body.
  MW_INLINE std::uint32_t lanes_of(int body, std::uint32_t lanes) const {
    return body < t_.bodies ? w_.direct.held[body] & lanes : 0u;
  }

  static MW_INLINE WrenchOf<S> on_a(const Row<S>& s, Float p) {
    return {load_as<Ang>(s.angular_a[0]) * -p, load_as<Vec>(s.linear_a[0]) * -p};
  }
  static MW_INLINE WrenchOf<S> on_b(const Row<S>& s, Float p) {
    return {load_as<Ang>(s.angular_b[0]) * p, load_as<Vec>(s.linear_b[0]) * p};
  }
  static MW_INLINE WrenchOf<S> on_a(const PointRows<S>& s, Vec p) {
    return {cross(load_as<Vec>(s.arm_a[0]), -p), -p};
  }
  static MW_INLINE WrenchOf<S> on_b(const PointRows<S>& s, Vec p) {
    return {cross(load_as<Vec>(s.arm_b[0]), p), p};
  }
  static MW_INLINE Float impulse_along(const Row<S>& s) { return along_row(s); }
  static MW_INLINE Vec impulse_along(const PointRows<S>& s) { return load_as<Vec>(s.impulse[0]); }

  // What an impulse along a row or at a point does to both ends.
  template <class Rows, class P>
  MW_INLINE SideTwists of_impulse(const TreePaths<S, true>& paths, const Rows& s, P p) const {
    const WrenchOf<S> a = on_a(s, p), b = on_b(s, p);
    const std::uint32_t tree_a = lanes_of(s.body_a, s.mask), tree_b = lanes_of(s.body_b, s.mask);
    if (tree_a != 0) paths.push(s.body_a, a, tree_a);
    if (tree_b != 0) paths.push(s.body_b, b, tree_b);
    const SideTwists out{twist_of(paths, s.a, s.body_a, a, tree_a),
                         twist_of(paths, s.b, s.body_b, b, tree_b)};
    if (tree_a != 0) paths.clear(s.body_a);
    if (tree_b != 0) paths.clear(s.body_b);
    return out;
  }
  static MW_INLINE TwistOf<S> twist_of(const TreePaths<S, true>& paths,
                                       const SideRows<S, Jointed>& side, int body,
                                       const WrenchOf<S>& p, std::uint32_t tree) {
    const TwistOf<S> free{apply(inertia_of(side), p.n), p.f * Float::load(side.inv_mass)};
    if (tree == 0) return free;
    const TwistOf<S> held = fma(free, Float(kLoopFloor), paths.change_of(body));
    return select(mask_from_bits(tree), held, free);
  }

  MW_INLINE void weigh_part(const TreePaths<S, true>& paths, Mask trees, Row<S>& s) const {
    const Float one(Real(1));
    const SideTwists v = of_impulse(paths, s, one);
    const Float k = dot(v.a, on_a(s, one)) + dot(v.b, on_b(s, one));
    select(trees, k, Float::load(s.free_k)).store(s.k);
  }
  MW_INLINE void weigh_part(const TreePaths<S, true>& paths, Mask trees, PointRows<S>& s) const {
    using Mass = typename PointMass<S>::Type;
    const Float zero(Real(0)), one(Real(1));
    const auto speed = [&](Vec p) {
      const SideTwists v = of_impulse(paths, s, p);
      return (v.b.v - v.a.v) +
             (cross(v.b.w, load_as<Vec>(s.arm_b[0])) - cross(v.a.w, load_as<Vec>(s.arm_a[0])));
    };
    Mass k;
    if constexpr (S::kDim == 2) {
      const Vec x = speed({one, zero}), y = speed({zero, one});
      k = {x.x, x.y, y.y};
    } else {
      const Vec x = speed({one, zero, zero}), y = speed({zero, one, zero}),
                z = speed({zero, zero, one});
      k = {x.x, x.y, x.z, y.y, y.z, z.z};
    }
    // The spring's own compliance is as it was.
    const Mass all = inverse(k + load_as<Mass>(s.mass[0]));
    store(s.soft_mass[0], select(trees, all, load_as<Mass>(s.soft_mass[0])));
  }

  template <Pass kPass, class Rows>
  void solve_part(const TreeResponse<S, kDense>& response, const JointPart& part,
                  const Joint& constants, Rows& s) const {
    const std::uint32_t tree_a = lanes_of(s.body_a, s.mask), tree_b = lanes_of(s.body_b, s.mask);
    const PartVelocities<S, kDense> began(w_, s);
    PartVelocities<S, kDense> v = began;
    const auto load = [&](int body, std::uint32_t lanes, Velocity<S>& to) {
      if (lanes != 0) to = select(mask_from_bits(lanes), response.velocity_of(body), to);
    };
    load(s.body_a, tree_a, v.a), load(s.body_b, tree_b, v.b);
    const auto before = impulse_along(s);
    solve_placed<S, kDense, kPass>(t_, g_, w_, part, constants, s, v);
    const auto p = impulse_along(s) - before;
    const std::uint32_t some = bits(Float(Real(0)) < square(p));
    const auto act = [&](int body, std::uint32_t lanes, const WrenchOf<S>& on,
                         const Velocity<S>& old, Velocity<S>& to) {
      if (lanes == 0) return;
      to = select(mask_from_bits(lanes), old, to);
      if ((lanes & some) != 0) response.push(body, on, lanes & some);
    };
    act(s.body_a, tree_a, on_a(s, p), began.a, v.a),
        act(s.body_b, tree_b, on_b(s, p), began.b, v.b);
    v.store(w_, s);
  }
  static MW_INLINE Float square(Float p) { return p * p; }
  static MW_INLINE Float square(Vec p) { return dot(p, p); }

  const Constants& t_;
  const Group& g_;
  Work& w_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
