// The stages of a contact step that are not solver passes, declared for table.cpp and each other.
#pragma once

#include "kernels/work.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

void begin(const Tables& t, const Group& g, kernels::Scratch* scratch);
void broad_phase(const Tables& t, const Group& g, kernels::Scratch* scratch);
kernels::Layout choose_layout(const Tables& t, const Group& g, kernels::Scratch* scratch,
                              kernels::Layout wish);

void sort_and_sweep(const Tables& t, Work& w);

// Fills w.candidates with the hits of the class at work.
void list_candidates(const Tables& t, Work& w);
// Keeps of `from` the lanes in `keep[slot]`, in `to`, with their axis.
void compact(const Tables& t, Work& w, const CandidateList& from, const std::uint32_t* keep,
             CandidateList& to);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
