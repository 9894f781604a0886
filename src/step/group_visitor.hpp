// GroupVisitor: what a caller does with each group of worlds around its steps, on the
// thread that steps it.
#pragma once

#include <cstdint>
#include <span>

#include "src/state/worlds_base.hpp"
#include "src/step/pipeline.hpp"

namespace manyworlds {

template <class Real>
struct VisitedGroup {
  int group;   // worlds without sleep: lane l is world group * lanes + l
  int thread;  // worker of the executor
  const kernels::Kernels<Real>& kernels;
  const kernels::SceneConstants<Real>& tables;
  const kernels::GroupView<Real>& view;
  Real* control;  // [control][lane]
  // Of the last step, or of the state where worlds begin; null: nothing is observed.
  const kernels::ObserverView<Real>* seen;
  const WorldsBase& worlds;  // all of the kind: to read those of the group
  bool whole;  // this visit takes all steps of the call: what this thread has put down still holds
};

class GroupVisitor {
 public:
  virtual ~GroupVisitor() = default;
};

// How worlds begin an episode.
struct Beginning {
  bool first = false;                         // of all episodes of their seeds
  bool resets = false;                        // or in the state that they have
  std::span<const std::uint64_t> seeds = {};  // [world] of resets to first episodes
};

// Visits the groups around their steps. A call that steps in parts begins with the first of
// them and ends with the last.
struct Visit {
  GroupVisitor* visitor = nullptr;
  bool begins = true, ends = true;
};

// Calls for different groups overlap in time; neither of them throws or waits.
template <class Real>
class GroupVisitorOf : public GroupVisitor {
 public:
  virtual void before_steps(const VisitedGroup<Real>& group) = 0;
  virtual void after_steps(const VisitedGroup<Real>& group) = 0;
  // Before the worlds in these lanes begin: numbers of the scene may be set for it.
  virtual void before_beginning(const VisitedGroup<Real>& group, WorldsBase& worlds,
                                std::uint32_t lanes, const Beginning& beginning) = 0;
  // After the worlds in these lanes began anew.
  virtual void after_beginning(const VisitedGroup<Real>& group, std::uint32_t lanes) = 0;
  // Between steps: nothing may change.
  virtual void between_steps(const VisitedGroup<Real>& group) = 0;
};

}  // namespace manyworlds
