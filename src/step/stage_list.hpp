// The calls of a step of one plan, in order: its stages (src/plan/stages.hpp) as functions of the
// kernels. What the plan leaves out is not in the list. Made once for a batch.
#pragma once

#include <cstddef>
#include <vector>

#include "kernels/data/observer.hpp"
#include "src/plan/plan_data.hpp"

namespace manyworlds {

template <class Real>
struct StageCall {
  StepStage stage;
  kernels::Stage<Real> run;
};

// In one layout of contacts.
template <class Real>
struct StageCalls {
  using Calls = std::vector<StageCall<Real>>;

  kernels::Stage<Real> enter = nullptr;  // before rows are built: velocities into the layout
  Calls prepare;  // after: rows of joints, and the velocities that the first substep begins with
  Calls solve;    // to the velocities that a substep ends with, and the displacement
  Calls next;     // to those that the next begins with
  Calls end;

  // Where in `solve` the solver can be asked how far it is from done, and the passes of one more
  // sweep; nullptr: it has no such rows.
  std::size_t residual_at = 0;
  kernels::Stage<Real> joint_sweep = nullptr, contact_sweep = nullptr;
  // After each substep of one whose energy is audited; nullptr: no joint gives any.
  kernels::Stage<Real> drive_work = nullptr;
};

template <class Real>
class StageList {
 public:
  StageList(const PlanData& plan, const kernels::SceneConstants<Real>& tables,
            const kernels::Kernels<Real>& kernels);

  const StageCalls<Real>& operator[](kernels::Layout layout) const {
    switch (layout) {
      case kernels::Layout::none: return free_;
      case kernels::Layout::rows: return rows_;
      default: return dense_;
    }
  }
  // Whether layout `none` has a step of its own; else it has the passes of `dense`.
  bool can_step_freely() const { return can_step_freely_; }
  // What joints hold in a state; nullptr: there are none.
  kernels::Stage<Real> gap_energy() const { return gap_energy_; }

 private:
  StageCalls<Real> dense_, rows_, free_;
  kernels::Stage<Real> gap_energy_ = nullptr;
  bool can_step_freely_ = false;
};

}  // namespace manyworlds
