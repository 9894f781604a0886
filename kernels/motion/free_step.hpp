// free_step: the step of a group in which nothing touches, instead of the passes of the solver.
// What those do to a body that no impulse reaches is done here operation by operation: a world has
// the same bits whether the worlds beside it touch something or not.
#pragma once

#include "kernels/motion/finish.hpp"
#include "kernels/rows/contact_cache.hpp"

namespace manyworlds::MW_KERNEL_NAMESPACE {

template <class S>
void free_step(const Constants& t, const Group& g, kernels::Scratch* scratch) {
  Work& w = work_of(scratch);
  enter_velocities<S, true>(t, g, w);
  enter_factors<S, true>(t, g, w);
  free_substeps<S>(t, w);
  CacheWriter(t, g, w).close();
  report_overflow(g, w);
  leave_state<S, true>(t, g, w, NoFlight{});
}

}  // namespace manyworlds::MW_KERNEL_NAMESPACE
