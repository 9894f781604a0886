// The passes of a substep, as each solver puts them in order (include/manyworlds/solver.hpp).
#include "src/step/stage_list.hpp"

namespace manyworlds {

namespace {

using kernels::Solver;

template <class Real>
class Builder {
 public:
  using Call = kernels::Stage<Real>;
  using Calls = typename StageCalls<Real>::Calls;

  Builder(const PlanData& plan, const kernels::SceneConstants<Real>& tables,
          const kernels::Kernels<Real>& k, kernels::Layout layout)
      : plan_(plan),
        t_(tables),
        layout_(layout == kernels::Layout::dense ? 0 : 1),
        solver_(k.solver[kind()][layout_]),
        sweeps_(k.sweeps[kind()][layout_]),
        impulses_(k.impulses[kind()]),
        joints_(k.joints[kind()][layout_]),
        trees_(k.direct[kind()][layout_]),
        flight_(k.flight[kind()]),
        settle_(k.settle) {}

  StageCalls<Real> build() {
    out_.enter = solver_.enter;
    prepare();
    switch (t_.solver.kind) {
      case Solver::tgs_soft: tgs_soft(); break;
      case Solver::nncg: nncg(); break;
      case Solver::penalty: penalty(); break;
      default: sequential_impulse();
    }
    if (joints() && t_.has_drives) out_.drive_work = joints_.drive_work;
    if (t_.breakable > 0) add(out_.solve, StepStage::joints, joints_.bear);
    if (t_.solver.kind != Solver::tgs_soft) add(out_.solve, StepStage::restitute, sweeps_.tally);
    next();
    end();
    return std::move(out_);
  }

 private:
  int kind() const { return static_cast<int>(t_.inertia_kind); }
  bool contacts() const { return plan_.runs(StepStage::collide); }
  bool joints() const { return plan_.runs(StepStage::joints); }
  bool trees() const { return joints() && t_.joint_trees.edges > 0; }
  // Whether some parts of joints are swept over.
  bool sweeps() const {
    return joints() && t_.joint_trees.parts + t_.joint_trees.attached < t_.parts;
  }
  bool trees_touch() const { return trees() && contacts(); }
  // Whether something acts on trees between two of their solves.
  bool trees_are_loaded() const { return trees_touch() || rows_attached(); }
  bool rows_attached() const { return trees() && t_.joint_trees.attached > 0; }
  // Impulses are those of one substep alone: nothing is carried over.
  bool forgets() const { return t_.solver.kind == Solver::penalty; }

  // Sleep is chosen for a batch, so the plan cannot tell whether its bodies settle.
  void add(Calls& to, StepStage stage, Call call) const {
    if (stage == StepStage::settle ? t_.has_sleep : plan_.runs(stage)) to.push_back({stage, call});
  }
  // A pass over contacts that carries what it does over to the next substep.
  void add_carried(Calls& to, StepStage stage, Call pass) const {
    if (!contacts()) return;
    if (joints()) add(to, stage, solver_.mark);
    add(to, stage, pass);
    if (joints()) add(to, stage, solver_.gather);
  }
  void ask_here(Call joint_sweep, Call contact_sweep) {
    out_.residual_at = out_.solve.size();
    out_.joint_sweep = joints() ? joint_sweep : nullptr;
    out_.contact_sweep = contacts() ? contact_sweep : nullptr;
  }

  void prepare() {
    Calls& to = out_.prepare;
    add(to, StepStage::flight, flight_.fly);
    add(to, StepStage::joints, joints_.prepare);
    if (trees()) add(to, StepStage::joints, trees_.begin);
    if (forgets()) add(to, StepStage::warm_start, impulses_.forget);
    add(to, StepStage::warm_start, solver_.apply_delta_v);
    add(to, StepStage::warm_start, solver_.warm_start);
    add(to, StepStage::resist, solver_.warm_start_resistance);
    add(to, StepStage::warm_start, solver_.open);
    add(to, StepStage::joints, joints_.warm_start);
  }

  void tgs_soft() {
    Calls& to = out_.solve;
    if (t_.joints_curve) add(to, StepStage::joints, joints_.predict);
    // Trees are done with one solve, but for what those spoil that act on them.
    if (trees()) add(to, StepStage::joints, trees_.bias);
    for (int i = 0; i < t_.solver.iterations; ++i) {
      if (sweeps()) add(to, StepStage::joints, joints_.bias);
      trees_are_loaded() ? round(StepStage::bias, trees_.bias_round, i > 0)
                         : add_carried(to, StepStage::bias, solver_.bias);
    }
    // One more brings loads from leg to leg, and to limits, drives and loops that rows do not see.
    if (trees_touch() ||
        (rows_attached() && (t_.joint_trees.bounded || t_.joint_trees.loops > 0))) {
      round(StepStage::bias, trees_.bias_round, true);
    }
    add(to, StepStage::advance, solver_.advance);
    add(to, StepStage::joints, joints_.rotate);
    if (trees()) add(to, StepStage::joints, trees_.relax);
    if (sweeps()) add(to, StepStage::joints, joints_.relax);
    if (trees_are_loaded()) {
      // Contacts push against limits and drives that give way only in the solve that follows: it
      // takes another round to take that back, else it feeds energy.
      round(StepStage::relax, trees_.relax_round, false);
      if (t_.joint_trees.bounded) round(StepStage::relax, trees_.relax_round, true);
    } else {
      add_carried(to, StepStage::relax, solver_.relax);
      add_carried(to, StepStage::resist, solver_.resist);
    }
    ask_here(joints_.relax, solver_.relax);
  }
  // What acts on trees, with their compliance, and then the trees.
  void round(StepStage stage, const kernels::TreeRound<Real>& of, bool again) {
    if (rows_attached()) add(out_.solve, StepStage::joints, again ? of.rows_again : of.rows);
    add_carried(out_.solve, stage, again ? of.contacts_again : of.contacts);
    add(out_.solve, StepStage::joints, of.trees);
  }
  void advance() {
    Calls& to = out_.solve;
    ask_here(joints_.bias, sweeps_.sweep);
    add(to, StepStage::advance, solver_.advance);
    for (int i = 0; t_.solver.splits && contacts() && i < t_.solver.iterations; ++i) {
      add(to, StepStage::advance, sweeps_.part);
    }
    add(to, StepStage::joints, joints_.rotate);
    // Rotation is no impulse to be carried over.
    if (joints() && contacts()) add(to, StepStage::advance, solver_.mark);
  }
  void sweep_once() {
    add(out_.solve, StepStage::joints, joints_.bias);
    add_carried(out_.solve, StepStage::bias, sweeps_.sweep);
    add_carried(out_.solve, StepStage::resist, solver_.resist);
  }
  // Projected Gauss-Seidel, and SOR, whose rows hold their relaxation.
  void sequential_impulse() {
    for (int i = 0; i < t_.solver.iterations; ++i) {
      sweep_once();
    }
    advance();
  }
  void nncg() {
    Calls& to = out_.solve;
    add(to, StepStage::warm_start, impulses_.begin_search);
    for (int i = 0; i < t_.solver.iterations; ++i) {
      const bool last = i + 1 == t_.solver.iterations;
      if (!last) add(to, StepStage::warm_start, impulses_.remember);
      sweep_once();
      if (last) break;
      add(to, StepStage::warm_start, impulses_.redirect);
      add(to, StepStage::joints, joints_.warm_start);
      add_carried(to, StepStage::warm_start, solver_.warm_start);
      add(to, StepStage::warm_start, impulses_.land);
    }
    advance();
  }
  void penalty() {
    for (int i = 0; i < t_.solver.iterations; ++i) {
      add(out_.solve, StepStage::joints, joints_.bias);
      add(out_.solve, StepStage::bias, sweeps_.sweep);
      add(out_.solve, StepStage::resist, solver_.resist);
    }
    advance();
  }

  void next() {
    Calls& to = out_.next;
    if (forgets()) add(to, StepStage::advance, impulses_.forget);
    // What the velocities have gained since is carried over, unless there is nothing to carry, or
    // it is what trees did.
    if (forgets() || !contacts() || trees()) add(to, StepStage::advance, solver_.mark);
    add(to, StepStage::advance, solver_.next);
    // Impulses are to act where the joints are now: at rows of the substep before they would feed
    // energy. Relaxing sweeps have brought them there already.
    if (t_.solver.kind != Solver::tgs_soft) add(to, StepStage::joints, joints_.follow);
    add(to, StepStage::joints, joints_.warm_start);
  }

  void end() {
    Calls& to = out_.end;
    add(to, StepStage::joints, joints_.store);
    // Impacts play between free bodies.
    if (trees_touch()) add(to, StepStage::restitute, trees_.weigh_alone);
    add(to, StepStage::restitute, solver_.restitute);
    add(to, StepStage::store, solver_.store);
    const bool flight = plan_.runs(StepStage::flight);
    add(to, StepStage::finish, flight ? flight_.leave[layout_] : solver_.leave);
    if (t_.breakable > 0) add(to, StepStage::joints, joints_.break_up);
    add(out_.settle, StepStage::settle, settle_);
  }

  const PlanData& plan_;
  const kernels::SceneConstants<Real>& t_;
  int layout_;
  const kernels::SolverTable<Real>& solver_;
  const kernels::SweepTable<Real>& sweeps_;
  const kernels::ImpulseTable<Real>& impulses_;
  const kernels::JointSolver<Real>& joints_;
  const kernels::DirectSolver<Real>& trees_;
  const kernels::FlightTable<Real>& flight_;
  Call settle_;
  StageCalls<Real> out_;
};

// Whether a body that nothing touches moves by itself, and by substeps alone.
template <class Real>
bool steps_freely(const PlanData& plan, const kernels::SceneConstants<Real>& t) {
  return t.solver.kind == Solver::tgs_soft && plan.runs(StepStage::collide) &&
         !plan.runs(StepStage::joints) && !plan.runs(StepStage::flight);
}
template <class Real>
StageCalls<Real> free_step_calls(const kernels::SceneConstants<Real>& t,
                                 const kernels::Kernels<Real>& kernels) {
  StageCalls<Real> out;
  out.end.push_back({StepStage::finish, kernels.free_step[static_cast<int>(t.inertia_kind)]});
  if (t.has_sleep) out.settle.push_back({StepStage::settle, kernels.settle});
  return out;
}

}  // namespace

template <class Real>
StageList<Real>::StageList(const PlanData& plan, const kernels::SceneConstants<Real>& tables,
                           const kernels::Kernels<Real>& kernels) {
  if (!tables.has_substeps || plan.has_trees()) return;
  dense_ = Builder<Real>(plan, tables, kernels, kernels::Layout::dense).build();
  rows_ = Builder<Real>(plan, tables, kernels, kernels::Layout::rows).build();
  if (steps_freely(plan, tables)) free_step_ = free_step_calls(tables, kernels);
  if (plan.runs(StepStage::joints)) {
    gap_energy_ = kernels.joints[static_cast<int>(tables.inertia_kind)][0].gap_energy;
  }
}

template class StageList<float>;
template class StageList<double>;

}  // namespace manyworlds
