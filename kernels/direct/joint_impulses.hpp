// Impulses of joints of trees, for those who observe and break them, and for the geometric
// stiffness: into the rows of their parts.
#pragma once

#include "kernels/direct/edges.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
class JointImpulses {
 public:
  // In some lanes; `first`: the substep has none yet, else they add up.
  JointImpulses(const Work& w, bool first, std::uint32_t lanes)
      : w_(w), first_(first), lanes_(lanes) {}

  // p: what the joint does to the child at its anchor.
  MW_INLINE void keep(const TreeEdge& edge, const EdgeRows<S>& s, WrenchOf<S> p) const {
    // Drives and limits keep what acts along the coordinates.
    if (edge.slides) {
      const auto axis = load_as<typename S::Vec>(s.slide_axis[0]);
      p.f = fnma(axis, dot(axis, p.f), p.f);
      put(part_rows<S, LineRows<S>>(w_, edge.hold), edge, s, p.f);
    } else {
      put(part_rows<S, PointRows<S>>(w_, edge.hold), edge, s, p.f);
    }
    if (edge.turn < 0) return;
    if (edge.locked) return put(part_rows<S, LockRows<S>>(w_, edge.turn), edge, s, p.n);
    if constexpr (S::kDim == 3) {
      const auto axis = load_vec3(s.turn_axis[0]);
      put(part_rows<S, SwingRows<S>>(w_, edge.turn), edge, s, fnma(axis, dot(axis, p.n), p.n));
    }
  }

 private:
  // Parts have what acts on B.
  template <class Rows, class V>
  MW_INLINE void put(Rows& to, const TreeEdge& edge, const EdgeRows<S>& s, V p) const {
    const auto old = load_as<V>(to.impulse[0]);
    if (edge.reversed) p = -p;
    if (!first_) p = old + p;
    p = select(mask_from_bits(s.lanes), p, zero_of<V>());
    store(to.impulse[0], select(mask_from_bits(lanes_), p, old));
  }

  const Work& w_;
  const bool first_;
  const std::uint32_t lanes_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
