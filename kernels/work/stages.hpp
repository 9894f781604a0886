// The stages of a contact step that are not solver passes, declared for table.cpp and each other.
#pragma once

#include "kernels/work/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void begin(const Constants& t, const Group& g, kernels::Scratch* scratch);
void broad_phase(const Constants& t, const Group& g, kernels::Scratch* scratch);
kernels::Layout choose_layout(const Constants& t, const Group& g, kernels::Scratch* scratch,
                              kernels::Layout wish);

// Inverse inertias in world axes and centres of mass, for the current orientations, or for those
// that the contacts of a step have (half_turn.hpp).
void rotate_body_rows(const Constants& t, const Group& g, Work& w, bool ahead);
void sort_and_sweep(const Constants& t, Work& w);
void find_sparse_pairs(const Constants& t, const Group& g, Work& w);

inline constexpr int kMaxTileCandidates = 4096;

// Maximum of candidates of a class in a lane: twice the manifolds that it can keep. Tiles of a
// height field are all candidates of any shape over it.
MW_INLINE int candidate_limit(const Constants& t, const kernels::PairClass<Real>& c) {
  const int limit = 2 * t.capacity[static_cast<int>(c.list)];
  if (!kernels::is_tile(c.kind) || limit > kMaxTileCandidates) return limit;
  return c.count < kMaxTileCandidates ? c.count : kMaxTileCandidates;
}

// Most candidates of a class that a lane can have.
MW_INLINE int max_candidates(const Constants& t, const kernels::PairClass<Real>& c) {
  const int limit = candidate_limit(t, c);
  return c.count < limit ? c.count : limit;
}

// Hits of a class, the first in w.hits and w.hit_masks, and the shapes of one of them.
MW_INLINE int first_hit(const Constants& t, const Work& w, int class_index) {
  return t.sparse ? w.sparse.hit_start[class_index] : t.pair_class[class_index].first_key;
}
MW_INLINE std::int32_t code_of_hit(const Constants& t, const Work& w, int class_index, int hit) {
  const auto& c = t.pair_class[class_index];
  if (t.sparse) return w.sparse.hit_code[w.sparse.hit_start[class_index] + hit];
  const std::int32_t place = w.hits[c.first_key + hit];
  return c.a[place] | (c.b[place] << 16);
}

// A rectangle and another or a circle, both of which move.
MW_INLINE bool is_rectangle_pair(const kernels::PairClass<Real>& c) {
  using K = kernels::ShapeKind;
  return !is_fixed(c.list) && shape_a(c.kind) == K::rectangle &&
         (shape_b(c.kind) == K::rectangle || shape_b(c.kind) == K::circle);
}
// Whether there are some whose distance may be asked: what moves them is in their speeds, but for
// gravity, which pulls all alike. With sleep, what bounds take for near hangs together.
MW_INLINE bool can_drop_distant(const Constants& t) {
  if (t.sparse || t.has_sleep) return false;
  if (!t.uniform_gravity || t.delta_v_varies || t.first_thrust || t.attractors > 0) return false;
  for (int i = 0; i < t.classes; ++i) {
    if (is_rectangle_pair(t.pair_class[i])) return true;
  }
  return false;
}
// Takes lanes out of the hits of such pairs whose shapes stay apart in the step.
void drop_distant(const Constants& t, const Group& g, Work& w);

// Fills w.candidates with the hits of the class at work.
void list_candidates(const Constants& t, Work& w);
// Keeps of `from` the lanes in `keep[block]`, in `to`, with their axis.
void compact(const Constants& t, Work& w, const CandidateList& from, const std::uint32_t* keep,
             CandidateList& to);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
