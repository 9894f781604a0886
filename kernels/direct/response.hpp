// What impulses of contacts do to a tree, one after the other, between two of its solves: each
// changes the velocities of all bodies of the tree, so that the next contact meets what is there
// (Gauss-Seidel in the coordinates of the joints, at the cost of a way to the root and back). An
// impulse goes up from its body to the root, and leaves at each joint what acts along the axes by
// which that gives way; a body's velocity comes down by what has been left so far. All of it is
// linear. Work::velocity stays as it was: the solve that follows takes the sums of the impulses, in
// DirectWork::own_load.
//
// Where a tree is cut, and at roots, the compliance is that with which contacts were weighed last:
// the solve that follows is exact again.
#pragma once

#include "kernels/direct/compliance.hpp"
#include "kernels/direct/edges.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
class TreeResponse {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  // By a set of factors.
  TreeResponse(const Constants& t, Work& w, int set) : t_(t), w_(w), d_(w.direct), set_(set) {}

  // Nothing has acted yet on the velocities that there are.
  void open() const {
    d_.pushed = 0;
    const Float zero(Real(0));
    const WrenchOf<S> none{zero_of<Ang>(), zero_of<Vec>()};
    for_each_tree_body(
        t_, [&](int b) { store(row(d_.own_load, b), none), store(row(d_.pending, b), none); });
    for (int i = 0; i < t_.joint_trees.edges; ++i) {
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      zero.store(s.slide.pending), zero.store(s.turn.pending);
      store(s.pending[0], zero_of<Ang>());
    }
  }

  // An impulse on a body about its centre of mass, in some lanes.
  void push(int body, WrenchOf<S> p, std::uint32_t lanes) const {
    d_.pushed |= lanes;
    add_in_lanes<kTwistRowsOf<S>>(row(d_.own_load, body), p, lanes);
    for (int i = edge_of(body); i >= 0; i = edge_of(body)) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      EdgeRows<S>& s = edge_rows<S>(w_, i);
      if (const std::uint32_t cut = lanes & ~s.lanes; cut != 0) {
        add_in_lanes<kTwistRowsOf<S>>(row(d_.pending, body), p, cut);
        lanes &= s.lanes;
      }
      if (lanes == 0) return;
      p = moved(p, load_as<Vec>(s.arm_child[0]));
      if (edge.slides) p = leave(s.slide, axis_of_slide(s), p, lanes);
      if (hinges(edge)) p = leave(s.turn, axis_of_turn(s), p, lanes);
      if constexpr (S::kDim == 3) {
        if (edge.ball) p = leave_rotation(s, p, lanes);
      }
      if (edge.prescribed) return;
      p = moved(p, -load_as<Vec>(s.arm_parent[0]));
      body = edge.parent;
    }
    add_in_lanes<kTwistRowsOf<S>>(row(d_.pending, body), p, lanes);
  }

  // The velocity of a body of a tree about its centre of mass.
  Velocity<S> velocity_of(int body) const {
    const Velocity<S> began = get_velocity<S, kDense>(w_, w_.velocity, body);
    if (d_.pushed == 0) return began;
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
    // Lanes in which nothing acts keep the sign of their zeros, whatever others do.
    return select(mask_from_bits(d_.pushed), Velocity<S>{began.v + v.v, began.w + v.w}, began);
  }

 private:
  int edge_of(int body) const { return t_.joint_trees.edge_of[body]; }
  static Real* row(Real* of, int body) { return of + body * kTwistRowsOf<S> * kLanes; }

  // Of what hangs on nothing.
  MW_INLINE TwistOf<S> alone(int body) const {
    return mul(load_as<ComplianceOf<S>>(d_.compliance + body * kComplianceRowsOf<S> * kLanes),
               load_as<WrenchOf<S>>(row(d_.pending, body)));
  }
  // From the parent's to the child's.
  MW_INLINE TwistOf<S> down(int i, TwistOf<S> v) const {
    const TreeEdge& edge = t_.joint_trees.edge[i];
    const EdgeRows<S>& s = edge_rows<S>(w_, i);
    v = moved(v, load_as<Vec>(s.arm_parent[0]));
    if (hinges(edge)) v = give_way(s.turn, axis_of_turn(s), v);
    if constexpr (S::kDim == 3) {
      if (edge.ball) v.w = turn_of(s.ball[set_], load_vec3(s.pending[0]), v.v);
    }
    if (edge.slides) v = give_way(s.slide, axis_of_slide(s), v);
    v = moved(v, -load_as<Vec>(s.arm_child[0]));
    if (s.lanes == kAllLanes) return v;
    return select(mask_from_bits(s.lanes), v, alone(edge.child));
  }
  MW_INLINE TwistOf<S> give_way(const EdgeDof<S>& dof, const TwistOf<S>& axis,
                                const TwistOf<S>& v) const {
    const DofFactors<S>& f = dof.factors[set_];
    const Float load = Float::load(dof.pending) - dot(v, load_as<WrenchOf<S>>(f.response[0]));
    return fma(axis, load * Float::load(f.inverse), v);
  }

  // What is left at a joint, and what goes on.
  MW_INLINE WrenchOf<S> leave(EdgeDof<S>& dof, const TwistOf<S>& axis, const WrenchOf<S>& p,
                              std::uint32_t lanes) const {
    const Float load = dot(axis, p);
    add_in_lanes<1>(dof.pending, load, lanes);
    const DofFactors<S>& f = dof.factors[set_];
    return fnma(load_as<WrenchOf<S>>(f.response[0]), load * Float::load(f.inverse), p);
  }
  MW_INLINE Wrench leave_rotation(EdgeRows<S>& s, const Wrench& p, std::uint32_t lanes) const
      requires(S::kDim == 3) {
    add_in_lanes<3>(s.pending[0], p.n, lanes);
    return without_turn(s.ball[set_], p);
  }

  const Constants& t_;
  Work& w_;
  DirectWork& d_;
  const int set_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
