// The step of one group: runs the stages of its plan. No arithmetic here.
#pragma once

#include <array>
#include <chrono>

#include "src/step/stage_list.hpp"

namespace manyworlds {

// Where a step's time goes, by stage; off unless it was asked for.
class StageClock {
 public:
  void start() { last_ = Clock::now(); }
  void lap(StepStage stage) {
    const auto now = Clock::now();
    seconds_[static_cast<std::size_t>(stage)] += std::chrono::duration<double>(now - last_).count();
    last_ = now;
  }
  std::array<double, kStepStages>& seconds() { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_;
  std::array<double, kStepStages> seconds_{};
};

template <class Real>
struct GroupStep {
  const kernels::Kernels<Real>& kernels;
  const kernels::SceneConstants<Real>& tables;
  const StageList<Real>& stages;
  kernels::Layout layout;
  // What observers need after the last step, and scratch for poses of shapes.
  const kernels::ObserverView<Real>* wanted = nullptr;
  kernels::Scratch* poses = nullptr;
};

// `steps` >= 1 whole steps of one group, fewer when all its worlds come to rest; returns how many.
// clock may be nullptr.
template <class Real>
int step_group(const GroupStep<Real>& plan, const kernels::GroupView<Real>& group,
               kernels::Scratch* scratch, int steps, StageClock* clock);

// What the state alone gives an observer: motion and rays, not contacts.
template <class Real>
void look_at_group(const GroupStep<Real>& plan, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch);

// The stages up to the narrow phase, without effect on the group.
template <class Real>
void collide_group(const GroupStep<Real>& plan, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch);

}  // namespace manyworlds
