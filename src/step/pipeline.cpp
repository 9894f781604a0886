#include "src/step/pipeline.hpp"

#include "src/step/substep.hpp"

namespace manyworlds {

namespace {

template <class Real>
const kernels::SolverTable<Real>& solver_of(const GroupStep<Real>& p, kernels::Layout layout) {
  const auto& t = p.tables;
  return p.kernels.solver[static_cast<int>(t.inertia_kind)][t.has_friction ? 1 : 0]
                         [layout == kernels::Layout::dense ? 0 : 1];
}
// Poses, and the rows of all contacts; velocities are then in the layout of the group.
template <class Real>
kernels::Layout find_rows(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                          kernels::Scratch* scratch, StageClock* clock) {
  const auto& t = p.tables;
  const auto lap = [clock](StageIndex stage) {
    if (clock) clock->lap(stage);
  };
  p.kernels.begin(t, group, scratch);
  lap(kBegin);
  kernels::Layout layout = kernels::Layout::dense;
  if (t.has_contacts) {
    p.kernels.broad_phase(t, group, scratch);
    layout = p.kernels.choose_layout(t, group, scratch, p.layout);
    lap(kBroadPhase);
  }
  const auto& solver = solver_of(p, layout);
  solver.enter(t, group, scratch);
  const auto* collide = p.kernels.collide[static_cast<int>(t.dimension)];
  for (int c = 0; c < t.classes; ++c) {
    p.kernels.set_class(scratch, c);
    collide[static_cast<int>(t.pair_class[c].kind)](t, group, scratch);
  }
  lap(kCollide);
  return layout;
}

template <class Real>
SolverRun<Real> run_of(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                       kernels::Scratch* scratch, StageClock* clock, kernels::Layout layout) {
  const int kind = static_cast<int>(p.tables.inertia_kind),
            rows = layout == kernels::Layout::dense ? 0 : 1;
  const auto& k = p.kernels;
  return {p.tables,
          group,
          scratch,
          clock,
          solver_of(p, layout),
          k.sweeps[kind][rows],
          k.impulses[kind],
          k.joints[kind][rows],
          *k.observer};
}

// Contacts and joints: rows in substeps. `wanted` in the last step of a call.
template <class Real>
void solver_step(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                 kernels::Scratch* scratch, StageClock* clock,
                 const kernels::Observation<Real>* wanted) {
  const auto& t = p.tables;
  const auto* slots = wanted && wanted->slots && t.has_contacts ? wanted : nullptr;
  if (slots) p.kernels.observer->watch(scratch, slots->places);
  const kernels::Layout layout = find_rows(p, group, scratch, clock);
  if (slots) p.kernels.observer->watch(scratch, nullptr);
  const bool adds_up = slots && slots->totals[0];
  SolverRun<Real> run = run_of(p, group, scratch, clock, layout);
  const auto& flight = p.kernels.flight[static_cast<int>(t.inertia_kind)];
  if (t.flight.on) {
    run.run(flight.fly);
    run.lap(kFlight);
  }
  run.on_joints(run.joints.prepare);
  begin_substeps(run);
  for (int s = 0; s < t.substeps; ++s) {
    if (s + 1 == t.substeps && wanted && wanted->residual) run.residual = wanted;
    solve_substep(run);
    if (t.breakable > 0) run.on_joints(run.joints.bear);
    if (t.has_restitution && t.solver.kind != kernels::Solver::tgs_soft) {
      run.run(run.sweeps.tally);
      run.lap(kRelax);
    }
    if (adds_up) {
      p.kernels.observer->accumulate[static_cast<int>(t.inertia_kind)](t, group, scratch, *slots);
      run.lap(kObserve);
    }
    if (s + 1 == t.substeps) break;
    next_substep(run);
  }
  run.on_joints(run.joints.store);
  if (t.has_restitution) {
    run.run(run.solver.restitute);
    run.lap(kRestitute);
  }
  if (t.has_contacts) run.run(run.solver.store);
  run.lap(kStore);
  run.run(t.flight.on ? flight.leave[layout == kernels::Layout::dense ? 0 : 1] : run.solver.leave);
  run.lap(kFinish);
  if (t.breakable > 0) run.run(run.joints.break_up);
  if (t.has_sleep) {
    p.kernels.settle(t, group, scratch);
    run.lap(kSettle);
  }
}

template <class Real>
bool at_rest(const GroupStep<Real>& p, const kernels::GroupView<Real>& group) {
  return p.tables.has_sleep && *group.resting == (1u << p.kernels.lanes) - 1;
}

// What the slots of the last step tell, if it has just been taken, and of pairs that are asleep
// what waits for them.
template <class Real>
void observe_slots(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch, bool taken) {
  const auto& t = p.tables;
  const auto& wanted = *p.wanted;
  const auto& observer = *p.kernels.observer;
  const int kind = static_cast<int>(t.inertia_kind);
  if (taken) observer.awake[kind](t, group, scratch, wanted);
  if (!t.has_sleep || *group.idle == 0) return;
  kernels::GroupView<Real> all_awake = group;
  all_awake.asleep = wanted.nobody;
  observer.watch(scratch, wanted.places);
  find_rows<Real>(p, all_awake, scratch, nullptr);
  observer.watch(scratch, nullptr);
  observer.asleep[kind](t, group, scratch, wanted);
}

}  // namespace

template <class Real>
void look_at_group(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch) {
  const auto& t = p.tables;
  const auto& observer = *p.kernels.observer;
  if (p.wanted->motion) {
    observer.motion[static_cast<int>(t.inertia_kind)](t, group, scratch, *p.wanted);
  }
  if (p.wanted->coordinates > 0) {
    observer.joints[static_cast<int>(t.inertia_kind)](t, group, scratch, *p.wanted);
  }
  if (p.wanted->joints > 0) {
    observer.joint_loads[static_cast<int>(t.inertia_kind)](t, group, scratch, *p.wanted);
  }
  if (p.wanted->rays > 0) {
    p.kernels.begin(t, group, p.poses);
    observer.rays(t, group, p.poses, *p.wanted);
  }
}

template <class Real>
int step_group(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
               kernels::Scratch* scratch, int steps, StageClock* clock) {
  if (clock) clock->start();
  int taken = 0;
  if (p.tables.has_substeps) {
    if (p.wanted) p.kernels.observer->clear(p.tables, group, scratch, *p.wanted);
    for (; taken < steps && !at_rest(p, group); ++taken) {
      solver_step(p, group, scratch, clock, taken + 1 == steps ? p.wanted : nullptr);
    }
    const bool slots = p.wanted && p.wanted->slots && p.tables.has_contacts;
    if (slots) observe_slots(p, group, scratch, taken == steps);
  } else {
    const auto& t = p.tables;
    const auto flight = p.kernels.flight[static_cast<int>(t.inertia_kind)].steps;
    const auto free_motion = p.kernels.free_motion[static_cast<int>(t.inertia_kind)];
    (t.flight.on ? flight : free_motion)(t, group, scratch, steps);
    if (clock) clock->lap(t.flight.on ? kFlight : kFreeMotion);
    taken = steps;
  }
  if (p.wanted) {
    look_at_group(p, group, scratch);
    if (clock) clock->lap(kObserve);
  }
  return taken;
}

template <class Real>
void collide_group(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch) {
  if (p.tables.has_contacts) find_rows<Real>(p, group, scratch, nullptr);
}

template int step_group<float>(const GroupStep<float>&, const kernels::GroupView<float>&,
                               kernels::Scratch*, int, StageClock*);
template void look_at_group<float>(const GroupStep<float>&, const kernels::GroupView<float>&,
                                   kernels::Scratch*);
template void look_at_group<double>(const GroupStep<double>&, const kernels::GroupView<double>&,
                                    kernels::Scratch*);
template int step_group<double>(const GroupStep<double>&, const kernels::GroupView<double>&,
                                kernels::Scratch*, int, StageClock*);
template void collide_group<float>(const GroupStep<float>&, const kernels::GroupView<float>&,
                                   kernels::Scratch*);
template void collide_group<double>(const GroupStep<double>&, const kernels::GroupView<double>&,
                                    kernels::Scratch*);

}  // namespace manyworlds
