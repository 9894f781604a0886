// Kernels: the one door into the kernels of an instruction set and precision. src/step calls
// the stages in order; no stage allocates, throws or keeps state outside its arguments.
#pragma once

#include <cstddef>

#include "kernels/data/group.hpp"

namespace manyworlds::kernels {

struct Scratch;  // per-thread work memory; its layout belongs to the kernels
template <class Real>
struct ObserverTable;  // kernels/data/observer.hpp

enum class Layout : int { automatic, dense, rows };

template <class Real>
using Stage = void (*)(const SceneConstants<Real>&, const GroupView<Real>&, Scratch*);

// The solver passes over all four lists, for one inertia kind, dense or rows.
template <class Real>
struct SolverTable {
  Stage<Real> enter;          // velocities into the solver's layout
  Stage<Real> apply_delta_v;  // of the first substep: gravity and inputs
  Stage<Real> warm_start;     // the stored impulses
  Stage<Real> open;           // what warm starting has added is known, the first substep begins
  // Around the passes of contacts, in plans with joints: their impulses alone are carried over to
  // the next substep as velocities.
  Stage<Real> mark;
  Stage<Real> gather;
  Stage<Real> bias;     // soft normal rows
  Stage<Real> advance;  // displacement of the substep
  Stage<Real> relax;    // normal rows without bias, then friction
  Stage<Real> next;     // delta_v and warm start of the next substep
  // Of plans with resistance: after warm_start, and after each pass with friction.
  Stage<Real> warm_start_resistance, resist;
  Stage<Real> restitute;
  Stage<Real> store;  // impulses into the cache
  Stage<Real> leave;  // commit positions, orientations, velocities
};

// The passes over contacts of solvers that sweep several times before the bodies move, for one
// inertia kind and layout.
template <class Real>
struct SweepTable {
  Stage<Real> sweep;
  Stage<Real> part;   // removes overlap by displacements
  Stage<Real> tally;  // after each substep, in plans with restitution
};

// The impulses of all rows, of joints and contacts, for one inertia kind.
template <class Real>
struct ImpulseTable {
  Stage<Real> forget;  // all of them are 0
  // Conjugate gradients, begun with each substep: `remember` and `redirect` around a sweep; then a
  // warm start with what `redirect` has put into the impulses, which `land` adds to what they were.
  Stage<Real> begin_search, remember, redirect, land;
};

// The passes over joints, for one inertia kind and layout; nothing of contacts in them.
template <class Real>
struct JointSolver {
  Stage<Real> prepare;     // rows at the start of the step; after SolverTable::enter
  Stage<Real> warm_start;  // the impulses so far, in every substep
  Stage<Real> predict;     // the motion of the substep, after warm_start (tgs_soft)
  Stage<Real> bias;        // with Options::relaxation where nothing bounds a part
  Stage<Real> rotate;      // bodies, after SolverTable::advance
  Stage<Real> relax;
  Stage<Real> follow;  // rows where the substeps have taken the bodies; relax does it by itself
  Stage<Real> store;
  // Of plans in which some joint may break: after relax, and at the end of the step.
  Stage<Real> bear;
  Stage<Real> break_up;
  // For the audit of energy: after each substep of an audited step, and of the state around it.
  Stage<Real> drive_work;
  Stage<Real> gap_energy;
};

// Of contacts by how trees give way, in place of SolverTable's passes, and of the trees that they
// have acted on.
template <class Real>
struct TreeRound {
  Stage<Real> rows, rows_again;          // attached to trees: first of a pass, later ones
  Stage<Real> contacts, contacts_again;  // after those
  Stage<Real> trees;
};

// Trees of joints that are solved at once (kernels/direct/), for one inertia kind and layout. Each
// solve leaves velocities with which the joints close what is apart (bias) or hold what they have.
template <class Real>
struct DirectSolver {
  Stage<Real> begin;  // after JointSolver::prepare
  Stage<Real> bias;   // the first of a substep
  Stage<Real> relax;  // where the substep has taken the bodies
  TreeRound<Real> bias_round, relax_round;
  Stage<Real> weigh_alone;  // after them: effective masses as of free bodies again
};

// The audit of energy (kernels/observe/audit.hpp).
template <class Real>
struct EnergyAudit {
  // Steps up to the next one in which some world is due, that one included.
  int (*ahead)(const SceneConstants<Real>&, const GroupView<Real>&);
  // Counts `steps`, no more than are ahead; whether the last of them is to be audited.
  bool (*count)(const SceneConstants<Real>&, const GroupView<Real>&, Scratch*, int steps);
  Stage<Real> clear;       // before JointSolver::gap_energy, which comes before these:
  Stage<Real> begin, end;  // around it
};

// Free flight by the integrator of the plan (kernels/flight/stages.hpp).
template <class Real>
struct FlightTable {
  // Whole steps of plans in which nothing else moves bodies.
  void (*steps)(const SceneConstants<Real>&, const GroupView<Real>&, Scratch*, int steps);
  Stage<Real> fly;       // before the passes of the solver
  Stage<Real> leave[2];  // after them, instead of SolverTable::leave; [layout: dense, rows]
};

// Plans whose bodies are in joint coordinates (kernels/tree/).
template <class Real>
struct TreeStages {
  // Substeps of plans without contacts.
  void (*steps)(const SceneConstants<Real>&, const GroupView<Real>&, Scratch*, int substeps);
  // Of the others: links and the poses of their bodies; then, when contacts are found, one substep.
  Stage<Real> pose, step;
  Stage<Real> runge_kutta[4];  // instead of a step, each after a pose
  Stage<Real> place;           // poses and velocities of bodies from the joint coordinates
};

template <class Real>
struct ContactPoint {
  std::int32_t list, key;    // key identifies class and candidate
  Real normal[3], point[3];  // point relative to nothing: world, m
  Real separation;
  Real impulse;
  std::int32_t feature;
};

template <class Real>
struct Kernels {
  const char* isa;
  int lanes;
  // Bytes of scratch that these tables need, and its set-up in `memory` (64-byte aligned).
  std::size_t (*scratch_bytes)(const SceneConstants<Real>&);
  Scratch* (*make_scratch)(const SceneConstants<Real>&, void* memory);

  Stage<Real> begin;        // poses, bounds, inertia
  Stage<Real> broad_phase;  // candidate masks of every class
  // Dense or rows for this group: by occupancy, or as wished if the blocks fit.
  Layout (*choose_layout)(const SceneConstants<Real>&, const GroupView<Real>&, Scratch*, Layout);
  // Narrow phase and rows of one class (set_class). [dimension: planar, spatial]
  Stage<Real> collide[2][kPairKinds];
  Stage<Real> gather_met;  // after them, of rows: which bodies contacts may act on
  SolverTable<Real> solver[kInertiaKinds][2];  // [inertia][layout: dense, rows]
  SweepTable<Real> sweeps[kInertiaKinds][2];   // [inertia][layout: dense, rows]
  ImpulseTable<Real> impulses[kInertiaKinds];
  // [inertia: planar, tensor][layout: dense, rows]
  JointSolver<Real> joints[kInertiaKinds][2];
  DirectSolver<Real> direct[kInertiaKinds][2];
  // Plans without contacts and joints: n whole steps of free motion.
  void (*free_motion[kInertiaKinds])(const SceneConstants<Real>&, const GroupView<Real>&, Scratch*,
                                     int steps);

  // Where nothing touches, in plans without joints: from the velocities to the commit.
  Stage<Real> free_step[kInertiaKinds];

  FlightTable<Real> flight[kInertiaKinds];

  TreeStages<Real> tree;

  EnergyAudit<Real> audit[kInertiaKinds];

  Stage<Real> settle;  // after the step: bodies at rest fall asleep (plans of batches with sleep)

  void (*set_class)(Scratch*, int class_index);  // which class collide works on
  const GroupCounters& (*counters)(Scratch*);    // of the last step
  // While set, collide writes the contact points of `lane` to out; returns their number when
  // called again. Pass nullptr to stop.
  int (*record)(Scratch*, int lane, ContactPoint<Real>* out, int max);

  const ObserverTable<Real>* observer;  // what batches with observers do beside the step
};

// Every kernel library defines
// manyworlds::<isa>_<precision>::fill_kernel_table(Kernels<Real>&).

}  // namespace manyworlds::kernels
