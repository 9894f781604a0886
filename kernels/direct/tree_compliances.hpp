// Compliances of the bodies of trees that contacts touch, from the root on, by a set of the
// factors of the edges.
#pragma once

#include "kernels/direct/ball.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
class TreeCompliances {
 public:
  using Vec = typename S::Vec;
  TreeCompliances(const Constants& t, Work& w, const TreeFactors<S>& factors)
      : t_(t), w_(w), d_(w.direct), factors_(factors) {}

  void find() const {
    for (int i = 0; i < t_.joint_trees.roots; ++i) {
      const int b = t_.joint_trees.root[i];
      if (d_.touched[b] != 0) store(row(b), alone(b));
    }
    for (int i = 0; i < t_.joint_trees.edges; ++i) {
      const TreeEdge& edge = t_.joint_trees.edge[i];
      if (d_.touched[edge.child] == 0) continue;
      const EdgeRows<S>& s = edge_rows<S>(w_, i);
      ComplianceOf<S> c = beyond_edge(edge, s, factors_.edge[i]);
      // The child is a root in the others.
      if (s.lanes != kAllLanes) c = select(mask_from_bits(s.lanes), c, alone(edge.child));
      store(row(edge.child), c);
    }
  }

 private:
  MW_INLINE ComplianceOf<S> alone(int body) const {
    return compliance_of(
        load_as<ArticulatedOf<S>>(factors_.inertia + body * kArticulatedRowsOf<S> * kLanes));
  }
  MW_INLINE ComplianceOf<S> beyond_edge(const TreeEdge& edge, const EdgeRows<S>& s,
                                        const EdgeFactors<S>& f) const {
    alignas(64) Real none[kComplianceRowsOf<S> * kLanes] = {};
    auto c = moved(load_as<ComplianceOf<S>>(edge.prescribed ? none : row(edge.parent)),
                   load_as<Vec>(s.arm_parent[0]));
    const auto pass = [&](const DofFactors<S>& dof, const TwistOf<S>& axis) {
      c = beyond(c, axis, load_as<WrenchOf<S>>(dof.response[0]), Float::load(dof.inverse));
    };
    if (hinges(edge)) pass(f.turn, axis_of_turn(s));
    if constexpr (S::kDim == 3) {
      if (edge.ball) {
        c = limited(edge) ? BallLimits<S>(edge, s, f).beyond(c)
                          : beyond_ball(c, load_as<Sym3>(f.ball.compliance[0]), mixed_of(f.ball));
      }
    }
    if (edge.slides) pass(f.slide, axis_of_slide(s));
    return moved(c, -load_as<Vec>(s.arm_child[0]));
  }
  MW_INLINE Real* row(int body) const {
    return d_.compliance + body * kComplianceRowsOf<S> * kLanes;
  }

  const Constants& t_;
  Work& w_;
  const DirectWork& d_;
  const TreeFactors<S> factors_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
