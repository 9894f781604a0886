// The calls of a step of one plan, in order: its stages (src/plan/stages.hpp) as functions of the
// kernels. What the plan leaves out is not in the list. Made once for a batch.
#pragma once

#include <cstddef>
#include <optional>
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
  Calls settle;  // once a step, after its last pass

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
    return layout == kernels::Layout::dense ? dense_ : rows_;
  }
  // Of a group in which nothing touches; nullptr: the passes of the solver have work even there.
  const StageCalls<Real>* free_step() const { return free_step_ ? &*free_step_ : nullptr; }
  // What joints hold in a state; nullptr: there are none.
  kernels::Stage<Real> gap_energy() const { return gap_energy_; }

 private:
  StageCalls<Real> dense_, rows_;
  std::optional<StageCalls<Real>> free_step_;
  kernels::Stage<Real> gap_energy_ = nullptr;
};

}  // namespace manyworlds
