// sleep: bodies that have been at rest for a while stop to take part in the step, island by island,
// and go on from their stored bits when something touches them.
//
// An island is what hangs together by the broad phase: bodies whose bounds, grown by the way they
// go in a step, overlap. So a body wakes before it can be touched, and what an awake body sees is
// never a sleeping one. Kinematic bodies without velocity count as asleep, but wake no body and are
// in no island.
#pragma once

#include "kernels/work/activity.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

struct LaneActivity {
  std::uint32_t asleep = 0, awake = 0, idle = 0;  // lanes in which some body is
};
LaneActivity activity_of(const Constants& t, const Group& g);

// Wakes the island that the body fell asleep with.
void wake_island(const Constants& t, const Group& g, int body, int lane);

// Wakes the islands that an awake body has come close to.
void wake_touched(const Constants& t, const Group& g, Work& w);

// Wakes the islands that a joint holds to an awake body.
void wake_joined(const Constants& t, const Group& g, const Work& w);

// Takes the stored impulses of sleeping pairs out of the caches of lanes that are partly asleep,
// to be merged with the new ones when the step stores those.
void keep_sleeping_contacts(const Constants& t, const Group& g, Work& w);

// After the step: measures how long each body has been at rest and puts islands to sleep.
void settle(const Constants& t, const Group& g, kernels::Scratch* scratch);

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
