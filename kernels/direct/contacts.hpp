// The passes over contacts of plans with trees of joints. Blocks none of whose bodies are of trees
// are solved as without any; in lanes in which a side is of no tree its numbers are the same.
#pragma once

#include "kernels/direct/contact_masses.hpp"
#include "kernels/rows/bounce_totals.hpp"
#include "kernels/rows/contact.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S, bool kDense>
class TreeContacts {
 public:
  TreeContacts(const Constants& t, Work& w) : t_(t), w_(w) {}

  // Effective masses. kTree: as parts of trees give way, else as free bodies do.
  template <bool kTree>
  void weigh() const {
    for_each_block<S>(w_, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      TreeSide<S> a{}, b = load_tree_side<S, kDense>(w_, s.offset_b, s.body_b, s.mask);
      if constexpr (A::kMoves) a = load_tree_side<S, kDense>(w_, s.offset_a, s.body_a, s.mask);
      const std::uint32_t lanes = a.lanes | b.lanes;
      if (lanes == 0) return;
      if constexpr (!kTree) a.lanes = b.lanes = 0;
      put_masses(t_, s, a, b, lanes);
      if (t_.has_resistance) put_turning(s, a, b, lanes, resistance_at<S>(list, i));
    });
  }

  // visit(body, lanes) for the bodies that move at both ends of all blocks.
  template <class Visit>
  MW_INLINE void for_each_end(Visit visit) const {
    for_each_block<S>(w_, [&]<int N, class A>(const SidedBlock<S, N, A>& s, int, BlockList&) {
      for_each_end_of(s, visit);
    });
  }

  template <Pass kPass>
  void solve(const TreeResponse<S, kDense>& response) const {
    for_each_block<S>(w_, [&]<int N, class A>(SidedBlock<S, N, A>& s, int, BlockList&) {
      if (meets_tree(s)) {
        TreeVelocities<S, A, kDense> v(response, w_, s);
        solve_rows<kDense, kPass>(t_, w_, s, v);
        v.store(s);
      } else {
        solve_block<kDense, kPass>(t_, w_, s);
      }
    });
    if constexpr (kPass == Pass::relax) {
      if (t_.has_resistance) resist_all(response);
    }
  }

  // What they did in a substep, for restitution.
  void accumulate_bounces() const {
    for_each_block<S>(w_, [&]<int N, class A>(SidedBlock<S, N, A>& s, int i, BlockList& list) {
      accumulate_bounce(s, bounce_at<S, N>(list, i), t_.has_friction);
    });
  }

 private:
  void resist_all(const TreeResponse<S, kDense>& response) const {
    for_each_resistance<S>(
        w_, [&]<int N, class A>(SidedBlock<S, N, A>& s, int, BlockList&, Resistance<S>& r) {
          TreeVelocities<S, A, kDense> v(response, w_, s);
          solve_resistance(s, r, v);
          v.store(s);
        });
  }
  // Of one block.
  template <int N, class A, class Visit>
  MW_INLINE void for_each_end_of(const SidedBlock<S, N, A>& s, Visit visit) const {
    for_each_body<S, kDense>(w_, s.offset_b, s.body_b, s.mask, visit);
    if constexpr (A::kMoves) for_each_body<S, kDense>(w_, s.offset_a, s.body_a, s.mask, visit);
  }
  template <int N, class A>
  MW_INLINE bool meets_tree(const SidedBlock<S, N, A>& s) const {
    std::uint32_t lanes = 0;
    for_each_end_of(s, [&](int body, std::uint32_t in) { lanes |= w_.direct.held[body] & in; });
    return lanes != 0;
  }

  const Constants& t_;
  Work& w_;
};

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
