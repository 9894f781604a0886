// What impulses of contacts and rows do to a tree, one after the other, between two of its solves:
// each changes the velocities of all bodies of the tree, so that the next one meets what is there
// (Gauss-Seidel in the coordinates of the joints, at the cost of a way to the root and back).
// Work::velocity stays as it was: the solve that follows takes the sums of the impulses, in
// DirectWork::own_load. What closes loops is not met, that solve does.
//
// Where a tree is cut, and at roots, the compliance is that with which contacts were weighed last:
// the solve that follows is exact again.
#pragma once

#include "kernels/direct/tree_paths.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
class TreeResponse {
 public:
  using Vec = typename S::Vec;
  using Ang = typename S::Ang;
  TreeResponse(const Constants& t, Work& w, const TreeFactors<S>& factors)
      : t_(t), w_(w), d_(w.direct), paths_(t, w, factors) {}

  // Nothing has acted yet on the velocities that there are.
  void open() const {
    d_.pushed = 0;
    const WrenchOf<S> none{zero_of<Ang>(), zero_of<Vec>()};
    for_each_tree_body(t_, [&](int b) { store(own_load(b), none); });
    paths_.open();
  }

  // An impulse on a body about its centre of mass, in some lanes.
  void push(int body, const WrenchOf<S>& p, std::uint32_t lanes) const {
    d_.pushed |= lanes;
    add_in_lanes<kTwistRowsOf<S>>(own_load(body), p, lanes);
    paths_.push(body, p, lanes);
  }

  // The velocity of a body of a tree about its centre of mass.
  Velocity<S> velocity_of(int body) const {
    const Velocity<S> began = get_velocity<S, kDense>(w_, w_.velocity, body);
    if (d_.pushed == 0) return began;
    const TwistOf<S> v = paths_.change_of(body);
    // Lanes in which nothing acts keep the sign of their zeros, whatever others do.
    return select(mask_from_bits(d_.pushed), Velocity<S>{began.v + v.v, began.w + v.w}, began);
  }

 private:
  Real* own_load(int body) const { return d_.own_load + body * kTwistRowsOf<S> * kLanes; }

  const Constants& t_;
  Work& w_;
  DirectWork& d_;
  const TreePaths<S, true> paths_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
