#include "src/step/pipeline.hpp"

namespace manyworlds {

namespace {

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
  kSettle
};

template <class Real>
const kernels::SolverTable<Real>& find_contacts(const GroupStep<Real>& p,
                                                const kernels::GroupView<Real>& group,
                                                kernels::Scratch* scratch, StageClock* clock) {
  const auto& t = p.tables;
  const auto lap = [clock](StageIndex stage) {
    if (clock) clock->lap(stage);
  };
  p.kernels.begin(t, group, scratch);
  lap(kBegin);
  p.kernels.broad_phase(t, group, scratch);
  const kernels::Layout layout = p.kernels.choose_layout(t, group, scratch, p.layout);
  lap(kBroadPhase);
  const auto& solver = p.kernels.solver[static_cast<int>(t.inertia_kind)][t.has_friction ? 1 : 0]
                                       [layout == kernels::Layout::dense ? 0 : 1];
  solver.enter(t, group, scratch);
  for (int c = 0; c < t.classes; ++c) {
    p.kernels.set_class(scratch, c);
    solver.collide[static_cast<int>(t.pair_class[c].kind)](t, group, scratch);
  }
  lap(kCollide);
  return solver;
}

template <class Real>
void contact_step(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                  kernels::Scratch* scratch, StageClock* clock) {
  const auto& t = p.tables;
  const auto lap = [clock](StageIndex stage) {
    if (clock) clock->lap(stage);
  };
  const auto& solver = find_contacts(p, group, scratch, clock);
  solver.warm_start(t, group, scratch);
  lap(kWarmStart);
  for (int s = 0; s < t.substeps; ++s) {
    solver.bias(t, group, scratch);
    lap(kBias);
    solver.advance(t, group, scratch);
    lap(kAdvance);
    solver.relax(t, group, scratch);
    lap(kRelax);
    if (s + 1 < t.substeps) solver.next(t, group, scratch);
    lap(kAdvance);
  }
  if (t.has_restitution) {
    solver.restitute(t, group, scratch);
    lap(kRestitute);
  }
  solver.store(t, group, scratch);
  lap(kStore);
  solver.leave(t, group, scratch);
  lap(kFinish);
  if (t.has_sleep) {
    p.kernels.settle(t, group, scratch);
    lap(kSettle);
  }
}

template <class Real>
bool at_rest(const GroupStep<Real>& p, const kernels::GroupView<Real>& group) {
  return p.tables.has_sleep && *group.resting == (1u << p.kernels.lanes) - 1;
}

}  // namespace

template <class Real>
int step_group(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
               kernels::Scratch* scratch, int steps, StageClock* clock) {
  if (clock) clock->start();
  if (!p.tables.has_contacts) {
    p.kernels.free_motion[static_cast<int>(p.tables.inertia_kind)](p.tables, group, scratch, steps);
    if (clock) clock->lap(kFreeMotion);
    return steps;
  }
  int taken = 0;
  for (; taken < steps && !at_rest(p, group); ++taken) contact_step(p, group, scratch, clock);
  return taken;
}

template <class Real>
void collide_group(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch) {
  if (p.tables.has_contacts) find_contacts<Real>(p, group, scratch, nullptr);
}

template int step_group<float>(const GroupStep<float>&, const kernels::GroupView<float>&,
                               kernels::Scratch*, int, StageClock*);
template int step_group<double>(const GroupStep<double>&, const kernels::GroupView<double>&,
                                kernels::Scratch*, int, StageClock*);
template void collide_group<float>(const GroupStep<float>&, const kernels::GroupView<float>&,
                                   kernels::Scratch*);
template void collide_group<double>(const GroupStep<double>&, const kernels::GroupView<double>&,
                                    kernels::Scratch*);

}  // namespace manyworlds
