#include "src/step/substep.hpp"

namespace manyworlds {

namespace {

using kernels::Solver;

// How far the solver is from done: what one more sweep would change.
template <class Real>
void look_at_residual(const SolverRun<Real>& run, kernels::Stage<Real> joints,
                      kernels::Stage<Real> contacts) {
  if (!run.residual) return;
  const auto& t = run.tables;
  run.observer.set_aside(t, run.group, run.scratch, *run.residual);
  if (t.has_joints) run.run(joints);
  if (t.has_contacts) run.run(contacts);
  run.observer.compare[static_cast<int>(t.inertia_kind)](t, run.group, run.scratch, *run.residual);
  run.lap(kObserve);
}

template <class Real>
void tgs_soft(const SolverRun<Real>& run) {
  for (int i = 0; i < run.tables.solver.iterations; ++i) {
    run.on_joints(run.joints.bias);
    run.on_contacts(run.solver.bias);
    run.lap(kBias);
  }
  run.run(run.solver.advance);
  run.lap(kAdvance);
  run.on_joints(run.joints.relax);
  run.on_contacts(run.solver.relax);
  run.lap(kRelax);
  look_at_residual(run, run.joints.relax, run.solver.relax);
}

template <class Real>
void advance(const SolverRun<Real>& run) {
  look_at_residual(run, run.joints.bias, run.sweeps.sweep);
  run.run(run.solver.advance);
  const auto& solver = run.tables.solver;
  for (int i = 0; solver.splits && run.tables.has_contacts && i < solver.iterations; ++i) {
    run.run(run.sweeps.part);
  }
  run.lap(kAdvance);
}

// Projected Gauss-Seidel, and SOR, whose rows know their relaxation.
template <class Real>
void sequential_impulse(const SolverRun<Real>& run) {
  for (int i = 0; i < run.tables.solver.iterations; ++i) {
    run.on_joints(run.joints.bias);
    run.on_contacts(run.sweeps.sweep);
    run.lap(kBias);
  }
  advance(run);
}

template <class Real>
void nncg(const SolverRun<Real>& run) {
  run.run(run.impulses.begin_search);
  for (int i = 0; i < run.tables.solver.iterations; ++i) {
    const bool last = i + 1 == run.tables.solver.iterations;
    if (!last) run.run(run.impulses.remember);
    run.on_joints(run.joints.bias);
    run.on_contacts(run.sweeps.sweep);
    run.lap(kBias);
    if (last) break;
    run.run(run.impulses.turn);
    run.on_joints(run.joints.warm_start);
    run.on_contacts(run.solver.warm_start);
    run.run(run.impulses.land);
    run.lap(kWarmStart);
  }
  advance(run);
}

// Impulses are those of this substep alone: nothing is carried over.
template <class Real>
void penalty(const SolverRun<Real>& run) {
  const auto& t = run.tables;
  for (int i = 0; i < t.solver.iterations; ++i) {
    run.on_joints(run.joints.bias);
    if (t.has_contacts) run.run(run.sweeps.sweep);
    run.lap(kBias);
  }
  advance(run);
}

template <class Real>
bool forgets(const SolverRun<Real>& run) {
  return run.tables.solver.kind == Solver::penalty;
}

}  // namespace

template <class Real>
void begin_substeps(const SolverRun<Real>& run) {
  if (forgets(run)) run.run(run.impulses.forget);
  run.run(run.solver.push);
  run.run(run.solver.warm_start);
  run.run(run.solver.open);
  run.lap(kWarmStart);
  run.on_joints(run.joints.warm_start);
}

template <class Real>
void solve_substep(const SolverRun<Real>& run) {
  switch (run.tables.solver.kind) {
    case Solver::tgs_soft: return tgs_soft(run);
    case Solver::nncg: return nncg(run);
    case Solver::penalty: return penalty(run);
    default: return sequential_impulse(run);
  }
}

template <class Real>
void next_substep(const SolverRun<Real>& run) {
  const auto& t = run.tables;
  if (forgets(run)) run.run(run.impulses.forget);
  // What the velocities have gained since is carried over, unless there is nothing to carry.
  if (forgets(run) || !t.has_contacts) run.run(run.solver.mark);
  run.run(run.solver.next);
  run.lap(kAdvance);
  // Impulses are to act where the joints are now: at rows of the substep before they would feed
  // energy. Relaxing sweeps have brought them there already.
  if (t.solver.kind != Solver::tgs_soft) run.on_joints(run.joints.follow);
  run.on_joints(run.joints.warm_start);
}

#define MW_INSTANTIATE(Real)                                  \
  template void begin_substeps<Real>(const SolverRun<Real>&); \
  template void solve_substep<Real>(const SolverRun<Real>&);  \
  template void next_substep<Real>(const SolverRun<Real>&);
MW_INSTANTIATE(float)
MW_INSTANTIATE(double)
#undef MW_INSTANTIATE

}  // namespace manyworlds
