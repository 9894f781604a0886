// The passes of a substep, as each solver puts them in order (include/manyworlds/solver.hpp).
#pragma once

#include "src/step/pipeline.hpp"

namespace manyworlds {

enum StageIndex {
  kFreeMotion,
  kBegin,
  kBroadPhase,
  kCollide,
  kWarmStart,
  kBias,
  kAdvance,
  kRelax,
  kRestitute,
  kStore,
  kFinish,
  kSettle,
  kObserve,
  kJoints,
  kFlight
};

// A group in the middle of a step, and what its layout takes.
template <class Real>
struct SolverRun {
  using Stage = kernels::Stage<Real>;

  const kernels::WorldTables<Real>& tables;
  const kernels::GroupView<Real>& group;
  kernels::Scratch* scratch;
  StageClock* clock;
  const kernels::SolverTable<Real>& solver;
  const kernels::SweepTable<Real>& sweeps;
  const kernels::ImpulseTable<Real>& impulses;
  const kernels::JointSolver<Real>& joints;
  const kernels::ObserverTable<Real>& observer;
  const kernels::Observation<Real>* residual = nullptr;  // where to put it, if it is wanted

  void run(Stage stage) const { stage(tables, group, scratch); }
  void lap(StageIndex stage) const {
    if (clock) clock->lap(stage);
  }
  void on_joints(Stage stage) const {
    if (!tables.has_joints) return;
    run(stage);
    lap(kJoints);
  }
  // A pass over contacts that carries what it does over to the next substep.
  void on_contacts(Stage pass) const {
    if (!tables.has_contacts) return;
    if (tables.has_joints) run(solver.mark);
    run(pass);
    if (tables.has_joints) run(solver.gather);
  }
};

// The rows' impulses and velocities before the first substep, after joints are prepared.
template <class Real>
void begin_substeps(const SolverRun<Real>& run);

// From the velocities that the substep begins with to those that it ends with, and the displacement
// of the bodies.
template <class Real>
void solve_substep(const SolverRun<Real>& run);

// To the velocities that the next substep begins with.
template <class Real>
void next_substep(const SolverRun<Real>& run);

}  // namespace manyworlds
