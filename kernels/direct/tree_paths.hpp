// Impulses on bodies of a tree, and how those move then, by a set of factors. An impulse goes up
// from its body to the root, and leaves at each joint what acts along the axes by which that gives
// way; a body's velocity comes down by what has been left so far. All of it is linear.
#pragma once

#include "kernels/direct/ball.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

// What has been left at an edge: along its coordinates, and on what rotates freely.
template <class S>
struct alignas(64) PendingRows {
  Real slide[kLanes], turn[kLanes], moment[S::kAng][kLanes];
};

// kWeighed: roots move by DirectWork::compliance, with which contacts were weighed last; the solve
// that follows is exact again.
template <class S, bool kWeighed>
class TreePaths {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  TreePaths(const Constants& t, const Work& w, const TreeFactors<S>& factors)
      : t_(t), w_(w), d_(w.direct), factors_(factors) {}

  // Nothing has acted yet.
  void open() const {
    const Float zero(Real(0));
    const WrenchOf<S> none{zero_of<Ang>(), zero_of<Vec>()};
    for_each_tree_body(t_, [&](int b) { store(row(d_.pending, b), none); });
    for (int i = 0; i < t_.joint_trees.edges; ++i) {
      PendingRows<S>& left = pending(i);
      zero.store(left.slide), zero.store(left.turn), store(left.moment[0], zero_of<Ang>());
    }
  }

  // An impulse on a body about its centre of mass, in some lanes.
  void push(int body, WrenchOf<S> p, std::uint32_t lanes) const {
    for (int i = edge_of(body); i >= 0; i = edge_of(body)) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      const EdgeRows<S>& s = edge_rows<S>(w_, i);
      if (const std::uint32_t cut = lanes & ~s.lanes; cut != 0) {
        add_in_lanes<kTwistRowsOf<S>>(row(d_.pending, body), p, cut);
        lanes &= s.lanes;
      }
      if (lanes == 0) return;
      p = moved(p, load_as<Vec>(s.arm_child[0]));
      const EdgeFactors<S>& f = factors_.edge[i];
      PendingRows<S>& left = pending(i);
      if (edge.slides) p = leave(f.slide, axis_of_slide(s), p, left.slide, lanes);
      if (hinges(edge)) p = leave(f.turn, axis_of_turn(s), p, left.turn, lanes);
      if constexpr (S::kDim == 3) {
        if (edge.ball) {
          add_in_lanes<3>(left.moment[0], p.n, lanes);
          p = through_ball(edge, s, f, p);
        }
      }
      if (edge.prescribed) return;
      p = moved(p, -load_as<Vec>(s.arm_parent[0]));
      body = edge.parent;
    }
    add_in_lanes<kTwistRowsOf<S>>(row(d_.pending, body), p, lanes);
  }

  // Takes back all that impulses on a body have left on its way to the root.
  void clear(int body) const {
    const WrenchOf<S> none{zero_of<Ang>(), zero_of<Vec>()};
    for (int i = edge_of(body);; i = edge_of(body)) {
      store(row(d_.pending, body), none);
      if (i < 0) return;
      pending(i) = {};
      if (t_.joint_trees.edge[i].prescribed) return;
      body = t_.joint_trees.edge[i].parent;
    }
  }

  // How a body's velocity about its centre of mass has changed.
  TwistOf<S> change_of(int body) const {
    int steps = 0;
    TwistOf<S> v{zero_of<Ang>(), zero_of<Vec>()};
    for (int i = edge_of(body), b = body;; i = edge_of(b)) {
      if (i < 0) {
        v = alone(b);
        break;
      }
      d_.path[steps++] = i;
      b = t_.joint_trees.edge[i].parent;
      if (t_.joint_trees.edge[i].prescribed) break;
    }
    while (steps > 0) v = down(d_.path[--steps], v);
    return v;
  }

 private:
  int edge_of(int body) const { return t_.joint_trees.edge_of[body]; }
  static Real* row(Real* of, int body) { return of + body * kTwistRowsOf<S> * kLanes; }

  // Of what hangs on nothing.
  MW_INLINE TwistOf<S> alone(int body) const {
    const auto p = load_as<WrenchOf<S>>(row(d_.pending, body));
    if constexpr (kWeighed) {
      const Real* compliance = d_.compliance + body * kComplianceRowsOf<S> * kLanes;
      return mul(load_as<ComplianceOf<S>>(compliance), p);
    } else {
      const Real* inertia = factors_.inertia + body * kArticulatedRowsOf<S> * kLanes;
      return solve(load_as<ArticulatedOf<S>>(inertia), p);
    }
  }
  // From the parent's to the child's.
  MW_INLINE TwistOf<S> down(int i, TwistOf<S> v) const {
    const TreeEdge& edge = t_.joint_trees.edge[i];
    const EdgeRows<S>& s = edge_rows<S>(w_, i);
    const EdgeFactors<S>& f = factors_.edge[i];
    const PendingRows<S>& left = pending(i);
    v = moved(v, load_as<Vec>(s.arm_parent[0]));
    if (hinges(edge)) v = give_way(f.turn, axis_of_turn(s), left.turn, v);
    if constexpr (S::kDim == 3) {
      if (edge.ball) v.w = turn_by_ball(edge, s, f, load_vec3(left.moment[0]), v);
    }
    if (edge.slides) v = give_way(f.slide, axis_of_slide(s), left.slide, v);
    v = moved(v, -load_as<Vec>(s.arm_child[0]));
    if (s.lanes == kAllLanes) return v;
    return select(mask_from_bits(s.lanes), v, alone(edge.child));
  }
  static MW_INLINE Wrench through_ball(const TreeEdge& edge, const EdgeRows<S>& s,
                                       const EdgeFactors<S>& f, const Wrench& p) {
    if (!limited(edge)) return without_turn(f.ball, p);
    const BallLimits<S> limits(edge, s, f);
    return limits.pass(p, limits.at_rest(p.n));
  }
  static MW_INLINE Vec3 turn_by_ball(const TreeEdge& edge, const EdgeRows<S>& s,
                                     const EdgeFactors<S>& f, Vec3 moment, const Twist& v) {
    if (!limited(edge)) return turn_of(f.ball, moment, v.v);
    const BallLimits<S> limits(edge, s, f);
    BallImpulses p = limits.at_rest(moment);
    return limits.turn(moment, v, p);
  }
  static MW_INLINE TwistOf<S> give_way(const DofFactors<S>& f, const TwistOf<S>& axis,
                                       const Real* left, const TwistOf<S>& v) {
    const Float load = Float::load(left) - dot(v, load_as<WrenchOf<S>>(f.response[0]));
    return fma(axis, load * Float::load(f.inverse), v);
  }

  // What is left at a joint, and what goes on.
  static MW_INLINE WrenchOf<S> leave(const DofFactors<S>& f, const TwistOf<S>& axis,
                                     const WrenchOf<S>& p, Real* left, std::uint32_t lanes) {
    const Float load = dot(axis, p);
    add_in_lanes<1>(left, load, lanes);
    return fnma(load_as<WrenchOf<S>>(f.response[0]), load * Float::load(f.inverse), p);
  }
  MW_INLINE PendingRows<S>& pending(int edge) const {
    return reinterpret_cast<PendingRows<S>*>(d_.pending_edges)[edge];
  }

  const Constants& t_;
  const Work& w_;
  const DirectWork& d_;
  const TreeFactors<S> factors_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
