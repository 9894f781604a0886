// The limits of ball joints in the solves over trees: what Bound has of them, in BallLimits.
#pragma once

#include "kernels/direct/ball.hpp"
#include "kernels/direct/bounds.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
class BallBounds {
 public:
  BallBounds(const Constants& t, const Work& w, const EdgeBounds<S>& bounds)
      : t_(t), w_(w), bounds_(bounds) {}

  // After eliminate_rotation: what goes on to the parent. `firm`: see Bound::stiffness.
  void eliminate(int i, EdgeFactors<S>& f, ArticulatedInertia& inertia, std::uint32_t firm) const {
    Float k(Real(0));
    const auto stiffness = [&](Float pivot) {
      return [&k, pivot, firm](const auto& bound) { k = bound.stiffness(pivot, firm); };
    };
    BallLimits<S>::eliminate(
        t_.joint_trees.edge[i], rows(i), f, inertia,
        [&](Float pivot) { return bounds_.visit_cone(i, stiffness(pivot)), k; },
        [&](Float pivot) { return bounds_.visit_turn(i, stiffness(pivot)), k; });
  }
  // What goes on to the parent of a load; what limits do with that one at rest is kept.
  Wrench reduce(int i, const EdgeFactors<S>& f, const Wrench& load) const {
    EdgeRows<S>& s = rows(i);
    BallImpulses push{Float(Real(0)), Float(Real(0))};
    bounds_.visit_cone(i, [&](const auto& bound) { push.cone = bound.push(); });
    bounds_.visit_turn(i, [&](const auto& bound) { push.twist = bound.push(); });
    const BallLimits<S> limits(t_.joint_trees.edge[i], s, f);
    const BallImpulses p = limits.at_rest(load.n, push);
    p.cone.store(s.slide.load), p.twist.store(s.turn.load);
    return limits.pass(load, p);
  }
  // How the child turns. Of what the limits do Bound has pivot change - load, as of others.
  Vec3 turn(int i, const EdgeFactors<S>& f, Vec3 moment, const Twist& v) const {
    const TreeEdge& edge = t_.joint_trees.edge[i];
    EdgeRows<S>& s = rows(i);
    BallImpulses p{Float::load(s.slide.load), Float::load(s.turn.load)};
    const Vec3 out = BallLimits<S>(edge, s, f).turn(moment, v, p);
    const auto keep = [&](const Real* axis, const DofFactors<S>& of, Float impulse,
                          EdgeDof<S>& to) {
      const Float change = dot(load_vec3(axis), out - v.w);
      change.store(to.change);
      fms(Float::load(of.pivot), change, impulse).store(to.load);
    };
    if (edge.cone >= 0) keep(s.slide_axis[0], f.slide, p.cone, s.slide);
    if (edge.angle >= 0) keep(s.turn_axis[0], f.turn, p.twist, s.turn);
    return out;
  }

 private:
  EdgeRows<S>& rows(int i) const { return edge_rows<S>(w_, i); }

  const Constants& t_;
  const Work& w_;
  const EdgeBounds<S>& bounds_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
