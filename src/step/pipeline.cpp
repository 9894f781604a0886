#include "src/step/pipeline.hpp"

#include <algorithm>
#include <span>

namespace manyworlds {

namespace {

// After a stage of kernels with this many lanes: leaves the upper halves of vector registers
// unused. GCC 12 leaves that out at the end of some (Passes::next and apply_delta_v, which pass
// registers to functions of their own); what the program computes in SSE then waits for them, and
// the kernels after it, too. Compiled by -O3, which uses SSE where -O2 does not, ball2d steps at
// half its speed without (manyworlds bench --scenes ball2d, AVX-512).
inline void clear_upper_halves(int lanes) {
#if defined(__x86_64__) && defined(__GNUC__)
  if (lanes == 1) return;
  asm volatile("vzeroupper" ::
                   : "xmm0", "xmm1", "xmm2", "xmm3", "xmm4", "xmm5", "xmm6", "xmm7", "xmm8", "xmm9",
                     "xmm10", "xmm11", "xmm12", "xmm13", "xmm14", "xmm15");
#else
  static_cast<void>(lanes);
#endif
}

// A group in the middle of a step.
template <class Real>
struct Run {
  const GroupStep<Real>& step;
  const kernels::GroupView<Real>& group;
  kernels::Scratch* scratch;
  StageClock* clock;

  void lap(StepStage stage) const {
    if (clock) clock->lap(stage);
  }
  void operator()(kernels::Stage<Real> call) const {
    call(step.tables, group, scratch);
    clear_upper_halves(step.kernels.lanes);
  }
  void operator()(const StageCall<Real>& call) const {
    (*this)(call.run);
    lap(call.stage);
  }
  void operator()(std::span<const StageCall<Real>> calls) const {
    for (const StageCall<Real>& call : calls) (*this)(call);
  }
};

// Poses, and the rows of all contacts; velocities are then in the layout of the group. `watched`:
// somebody reads what the passes of the solver leave, so that they have to run.
template <class Real>
const StageCalls<Real>& find_rows(const Run<Real>& run, bool watched) {
  const GroupStep<Real>& p = run.step;
  const auto& t = p.tables;
  const bool chosen = p.layout != kernels::Layout::automatic;
  const StageCalls<Real>* free_step = watched || chosen ? nullptr : p.stages.free_step();
  const auto& counters = p.kernels.counters(run.scratch);
  run(StageCall<Real>{StepStage::begin, p.kernels.begin});
  kernels::Layout layout = kernels::Layout::dense;
  if (t.has_contacts) {
    run(p.kernels.broad_phase);
    layout = p.kernels.choose_layout(t, run.group, run.scratch, p.layout);
    run.lap(StepStage::broad_phase);
    if (free_step && counters.active == 0) return *free_step;
  }
  const StageCalls<Real>& calls = p.stages[layout];
  if (calls.enter) run(StageCall<Real>{StepStage::begin, calls.enter});
  const auto* collide = p.kernels.collide[static_cast<int>(t.dimension)];
  for (int c = 0; c < t.classes; ++c) {
    p.kernels.set_class(run.scratch, c);
    run(collide[static_cast<int>(t.pair_class[c].kind)]);
  }
  if (t.has_contacts) {
    if (layout == kernels::Layout::rows) run(p.kernels.gather_met);
    run.lap(StepStage::collide);
    if (free_step && counters.manifolds == 0) return *free_step;
  }
  return calls;
}

// How far the solver is from done: what one more sweep would change.
template <class Real>
void look_at_residual(const Run<Real>& run, const StageCalls<Real>& calls,
                      const kernels::ObserverView<Real>& wanted) {
  const GroupStep<Real>& p = run.step;
  const auto& observer = *p.kernels.observer;
  observer.save_rows(p.tables, run.group, run.scratch, wanted);
  if (calls.joint_sweep) run(calls.joint_sweep);
  if (calls.contact_sweep) run(calls.contact_sweep);
  observer.compare[static_cast<int>(p.tables.inertia_kind)](p.tables, run.group, run.scratch,
                                                            wanted);
  run.lap(StepStage::observe);
}

// The audit of a group's energies around the steps in which some world is due.
template <class Real>
class Audit {
 public:
  explicit Audit(const Run<Real>& run)
      : run_(run), audit_(run.step.kernels.audit[static_cast<int>(run.step.tables.inertia_kind)]) {}

  // Of `steps` steps those up to the next one that is audited; all where none is.
  int ahead(int steps) const {
    const auto& t = run_.step.tables;
    return t.audit_every > 0 && steps > 1 ? std::min(steps, audit_.ahead(t, run_.group)) : steps;
  }
  // Whether the last of as many steps as are ahead is to be audited.
  bool count(int steps) const {
    const auto& t = run_.step.tables;
    return t.audit_every > 0 && audit_.count(t, run_.group, run_.scratch, steps);
  }
  // Whether the next step is; `left` of the call. Those that are not are counted together, but
  // where worlds may come to rest in between.
  bool next(int left) {
    const auto& t = run_.step.tables;
    if (t.audit_every == 0) return false;
    if (counted_ == 0) {
      counted_ = t.has_sleep ? 1 : ahead(left);
      due_ = count(counted_);
    }
    return --counted_ == 0 && due_;
  }
  void begin() const { look(audit_.begin); }
  void end() const { look(audit_.end); }

 private:
  void look(kernels::Stage<Real> sum) const {
    run_(audit_.clear);
    if (run_.step.stages.gap_energy()) run_(run_.step.stages.gap_energy());
    run_(StageCall<Real>{StepStage::audit, sum});
  }

  const Run<Real>& run_;
  const kernels::EnergyAudit<Real>& audit_;
  int counted_ = 0;
  bool due_ = false;
};

// One pass of a step over contacts and joints: rows in substeps. `wanted` in the last step of a
// call, `last`: of the passes of a step.
template <class Real>
void solver_pass(const Run<Real>& run, const kernels::ObserverView<Real>* wanted, bool audited,
                 bool last) {
  const GroupStep<Real>& p = run.step;
  const auto& t = p.tables;
  const auto& observer = *p.kernels.observer;
  const auto* contacts = wanted && wanted->of_contacts && t.has_contacts ? wanted : nullptr;
  if (contacts) observer.watch(run.scratch, contacts->places);
  const bool saved = last && wanted && wanted->saved;
  const StageCalls<Real>& calls = find_rows(run, contacts || saved);
  if (contacts) observer.watch(run.scratch, nullptr);
  const bool adds_up = contacts && contacts->totals[0];
  const std::span<const StageCall<Real>> solve = calls.solve;
  run(calls.prepare);
  for (int s = 0; s < t.substeps; ++s) {
    run(solve.first(calls.residual_at));
    if (s + 1 == t.substeps && saved) look_at_residual(run, calls, *wanted);
    run(solve.subspan(calls.residual_at));
    if (audited && calls.drive_work) run(StageCall<Real>{StepStage::audit, calls.drive_work});
    if (adds_up) {
      observer.accumulate[static_cast<int>(t.inertia_kind)](t, run.group, run.scratch, *contacts);
      run.lap(StepStage::observe);
    }
    if (s + 1 < t.substeps) run(calls.next);
  }
  run(calls.end);
  if (contacts && t.passes > 1) {
    observer.awake[static_cast<int>(t.inertia_kind)](t, run.group, run.scratch, *contacts);
    if (t.has_sleep) std::copy_n(run.group.asleep, t.bodies, contacts->asleep_before);
    run.lap(StepStage::observe);
  }
  if (last) run(calls.settle);
}

// Bodies in joint coordinates: a step is as many substeps, each of which finds its own contacts.
// `wanted` where contacts of the last one are observed, or its last stage.
template <class Real>
void tree_steps(const Run<Real>& run, int steps, const kernels::ObserverView<Real>* wanted) {
  const GroupStep<Real>& p = run.step;
  const auto& t = p.tables;
  const auto& tree = p.kernels.tree;
  const auto& observer = *p.kernels.observer;
  if (steps == 0) return;
  const bool loads = wanted && wanted->before;
  int substeps = steps * t.substeps;
  if (!t.has_contacts) {
    const int alone = loads ? 1 : 0;  // with a look in the middle
    tree.steps(t, run.group, run.scratch, substeps - alone);
    run.lap(StepStage::tree);
    if (!loads) return;
    substeps = alone;
  }
  for (int i = 0; i < substeps; ++i) {
    for (int s = 0; s < t.tree.stages; ++s) {
      run(StageCall<Real>{StepStage::tree, tree.pose});
      if (t.has_contacts) find_rows(run, true);
      const bool last = i + 1 == substeps && s + 1 == t.tree.stages;
      if (loads && last) observer.keep_tree_state(t, run.group, run.scratch, *wanted);
      run(StageCall<Real>{StepStage::tree, t.tree.stages == 1 ? tree.step : tree.runge_kutta[s]});
    }
  }
  if (wanted) {
    const bool contacts = wanted->of_contacts && t.has_contacts;
    if (contacts) observer.of_trees(t, run.group, run.scratch, *wanted);
    if (loads && wanted->of_links) observer.links_of_trees(t, run.group, run.scratch, *wanted);
    if (loads && wanted->anchor) observer.loads_of_trees(t, run.group, run.scratch, *wanted);
    run.lap(StepStage::observe);
  }
  run(StageCall<Real>{StepStage::tree, tree.place});
}

// Steps of plans in which bodies move by themselves.
template <class Real, class Move>
void whole_steps(const Run<Real>& run, Move move, int steps) {
  const auto& t = run.step.tables;
  const Audit<Real> audit(run);
  const auto take = [&](int n) {
    for (int pass = 0; pass < t.passes; ++pass) move(t, run.group, run.scratch, n);
    run.lap(t.flight.on ? StepStage::flight : StepStage::free_motion);
  };
  while (steps > 0) {
    const int ahead = audit.ahead(steps);
    steps -= ahead;
    if (!audit.count(ahead)) {
      take(ahead);
      continue;
    }
    take(ahead - 1);
    audit.begin();
    take(1);
    audit.end();
  }
}

template <class Real>
bool at_rest(const GroupStep<Real>& p, const kernels::GroupView<Real>& group) {
  return p.tables.has_sleep && *group.resting == (1u << p.kernels.lanes) - 1;
}

// What the contacts of the last step tell, if it has just been taken, and of pairs that are asleep
// what waits for them.
template <class Real>
void observe_contacts(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                      kernels::Scratch* scratch, bool taken) {
  const auto& t = p.tables;
  const auto& wanted = *p.wanted;
  const auto& observer = *p.kernels.observer;
  const int kind = static_cast<int>(t.inertia_kind);
  const bool several = taken && t.passes > 1;  // passes, which have been observed one by one
  if (taken && !several) observer.awake[kind](t, group, scratch, wanted);
  if (!t.has_sleep || *group.idle == 0) return;
  kernels::GroupView<Real> all_awake = group;
  all_awake.asleep = wanted.none_asleep;
  observer.watch(scratch, wanted.places);
  find_rows(Run<Real>{p, all_awake, scratch, nullptr}, true);
  observer.watch(scratch, nullptr);
  kernels::GroupView<Real> before = group;
  if (several) before.asleep = wanted.asleep_before;
  observer.asleep[kind](t, before, scratch, wanted);
}

// Calls visit(function, scratch) of every observer that is asked for and has one in this table.
template <class Real, class Table, class Visit>
void for_each_observer(const GroupStep<Real>& p, const Table& table, kernels::Scratch* scratch,
                       Visit visit) {
  constexpr int kRays = static_cast<int>(Observer::rays);
  for (int i = 0; i < kObserverCount; ++i) {
    const auto function = table[i][static_cast<int>(p.tables.inertia_kind)];
    if (function && p.wanted->items[i] > 0) visit(function, i == kRays ? p.poses : scratch);
  }
}

template <class Real>
bool looks_at_start(const GroupStep<Real>& p) {
  bool found = false;
  if (!p.wanted) return found;
  for_each_observer(p, p.kernels.observer->begin, nullptr, [&](auto, auto*) { found = true; });
  return found;
}
// Before the last step of a call.
template <class Real>
void look_at_start(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch) {
  for_each_observer(p, p.kernels.observer->begin, scratch,
                    [&](auto begin, auto* s) { begin(p.tables, group, s, *p.wanted); });
}
template <class Real>
void look_at_end(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                 kernels::Scratch* scratch) {
  if (p.wanted->rows[static_cast<int>(Observer::rays)]) p.kernels.begin(p.tables, group, p.poses);
  for_each_observer(p, p.kernels.observer->look, scratch,
                    [&](auto look, auto* s) { look(p.tables, group, s, *p.wanted); });
}

}  // namespace

template <class Real>
void look_at_group(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch) {
  look_at_start(p, group, scratch);
  if (p.wanted->of_links) p.kernels.observer->look_at_links(p.tables, group, scratch, *p.wanted);
  look_at_end(p, group, scratch);
}

template <class Real>
int step_group(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
               kernels::Scratch* scratch, int steps, StageClock* clock) {
  if (clock) clock->start();
  int taken = 0;
  if (p.tables.tree.links > 0) {
    const int last = looks_at_start(p) ? 1 : 0;  // taken by itself
    const Run<Real> run{p, group, scratch, clock};
    const bool contacts = p.wanted && p.wanted->of_contacts && p.tables.has_contacts;
    const auto* wanted = contacts || (p.wanted && p.wanted->before) ? p.wanted : nullptr;
    if (p.wanted) p.kernels.observer->clear(p.tables, group, scratch, *p.wanted);
    tree_steps(run, steps - last, last == 0 ? wanted : nullptr);
    if (p.wanted) look_at_start(p, group, scratch);
    tree_steps(run, last, wanted);
    taken = steps;
  } else if (p.tables.has_substeps) {
    const Run<Real> run{p, group, scratch, clock};
    Audit<Real> audit(run);
    if (p.wanted) p.kernels.observer->clear(p.tables, group, scratch, *p.wanted);
    for (; taken < steps && !at_rest(p, group); ++taken) {
      const auto* wanted = taken + 1 == steps ? p.wanted : nullptr;
      if (wanted) look_at_start(p, group, scratch);
      const bool audited = audit.next(steps - taken);
      if (audited) audit.begin();
      for (int pass = 1; pass <= p.tables.passes; ++pass) {
        solver_pass(run, wanted, audited, pass == p.tables.passes);
      }
      if (audited) audit.end();
    }
    if (p.wanted && taken < steps) look_at_start(p, group, scratch);
    const bool contacts = p.wanted && p.wanted->of_contacts && p.tables.has_contacts;
    if (contacts) observe_contacts(p, group, scratch, taken == steps);
  } else {
    const auto& t = p.tables;
    const auto flight = p.kernels.flight[static_cast<int>(t.inertia_kind)].steps;
    const auto free_motion = p.kernels.free_motion[static_cast<int>(t.inertia_kind)];
    const auto move = t.flight.on ? flight : free_motion;
    const Run<Real> run{p, group, scratch, clock};
    const int last = looks_at_start(p) ? 1 : 0;  // taken by itself
    whole_steps(run, move, steps - last);
    if (p.wanted) look_at_start(p, group, scratch);
    whole_steps(run, move, last);
    taken = steps;
  }
  if (p.wanted) {
    look_at_end(p, group, scratch);
    if (clock) clock->lap(StepStage::observe);
  }
  return taken;
}

template <class Real>
void collide_group(const GroupStep<Real>& p, const kernels::GroupView<Real>& group,
                   kernels::Scratch* scratch) {
  if (p.tables.has_contacts) find_rows(Run<Real>{p, group, scratch, nullptr}, true);
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
