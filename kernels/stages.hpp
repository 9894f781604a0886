// The stages of a contact step that are not solver passes, declared for table.cpp and each other.
#pragma once

#include "kernels/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void begin(const Tables& t, const Group& g, kernels::Scratch* scratch);
void broad_phase(const Tables& t, const Group& g, kernels::Scratch* scratch);
kernels::Layout choose_layout(const Tables& t, const Group& g, kernels::Scratch* scratch,
                              kernels::Layout wish);

// Inverse inertias in world axes and centres of mass, for the current orientations.
void turn_body_rows(const Tables& t, const Group& g, Work& w);
void sort_and_sweep(const Tables& t, Work& w);

// Most candidates of a class that a lane may have: twice the manifolds that it can keep.
MW_INLINE int candidate_limit(const Tables& t, const kernels::PairClass<Real>& c) {
  return 2 * t.capacity[static_cast<int>(c.list)];
}

// Fills w.candidates with the hits of the class at work.
void list_candidates(const Tables& t, Work& w);
// Keeps of `from` the lanes in `keep[slot]`, in `to`, with their axis.
void compact(const Tables& t, Work& w, const CandidateList& from, const std::uint32_t* keep,
             CandidateList& to);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
