// Batch: N worlds of one or several Plans, and the step.
//
// One SIMD lane holds one world; groups of worlds spread over threads. A world's bits after n
// steps depend on its Plan, its initial state and its inputs, on nothing else: not on its lane,
// the batch size, the thread count, the contact layout or the instruction set
// (docs/determinism.md).
//
// A Batch is not thread safe: one thread calls it at a time. Different Batches share nothing.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/batch_options.hpp"
#include "manyworlds/listener.hpp"
#include "manyworlds/pimpl.hpp"
#include "manyworlds/plan.hpp"
#include "manyworlds/results.hpp"
#include "manyworlds/snapshot.hpp"
#include "manyworlds/state.hpp"

namespace manyworlds {

// Asked now and then by a call that takes long, on its thread: false ends the call early. An
// exception ends it in the same state as false does (steps() counts the steps taken) and reaches
// the caller. Must not use what it is asked by. Empty: nothing is asked.
using GoOn = std::function<bool()>;

class Batch {
 public:
  // Throws std::invalid_argument for options that make no sense (worlds < 1, threads not 0 to
  // kMaxThreads or given beside an executor, an ISA that is not available, a value that an
  // enumeration does not have), and for worlds that need more memory than the machine has; it says
  // how much that is. Throws std::system_error where options.threads cannot be started.
  explicit Batch(Plan plan, const BatchOptions& options = {});

  // Several kinds of world: `worlds` of each plan, in this order. options.worlds is ignored.
  // Plans must be all planar or all spatial.
  struct Kind {
    Plan plan;
    int worlds = 1;
  };
  explicit Batch(std::vector<Kind> kinds, const BatchOptions& options = {});

  ~Batch();
  Batch(Batch&&) noexcept;
  Batch& operator=(Batch&&) noexcept;

  // ---- Shape of the batch
  int worlds() const;
  int kinds() const;
  const Plan& plan(int kind = 0) const;
  // As those of the kind's Plan: the one of a name, and where a body is in arrays [body].
  BodyId body(std::string_view name, int kind = 0) const { return plan(kind).body(name); }
  ShapeId shape(std::string_view name, int kind = 0) const { return plan(kind).shape(name); }
  JointId joint(std::string_view name, int kind = 0) const { return plan(kind).joint(name); }
  ControlId control(std::string_view name, int kind = 0) const { return plan(kind).control(name); }
  TendonId tendon(std::string_view name, int kind = 0) const { return plan(kind).tendon(name); }
  SiteId site(std::string_view name, int kind = 0) const { return plan(kind).site(name); }
  KeyframeId keyframe(std::string_view name, int kind = 0) const {
    return plan(kind).keyframe(name);
  }
  int row(BodyId body, int kind = 0) const { return plan(kind).row(body); }
  BodyId body_in_row(int row, int kind = 0) const { return plan(kind).body_in_row(row); }
  int kind_of(int world) const;
  int bodies(int world = 0) const;  // that have a state (rows of arrays)
  int threads() const;
  Isa isa() const;
  Precision precision() const;
  std::uint64_t seed() const;              // BatchOptions::seed
  std::uint64_t seed_of(int world) const;  // seed() + world, or what a reset gave it
  int lanes() const;
  std::string kernel_table() const;     // "avx2 f32 x8"
  std::size_t bytes_per_world() const;  // persistent state, mean over worlds
  std::size_t scratch_bytes() const;    // per thread

  // ---- Stepping

  // Allocates nothing, throws nothing (after the constructor, reset and the first force call), but
  // std::invalid_argument for n < 0, a clock that is not finite, or max_steps < 0. The calls return
  // how many steps were taken: n, unless `go_on`, which is asked between steps some 15 times a
  // second, ends the call: for hosts that must stay responsive. The bits are those of one call of
  // so many steps, and so is what inputs, observers and listeners see of it.
  int step(int n = 1, const GoOn& go_on = {});
  // Steps the worlds of a mask alone (one byte per world, nonzero = step): the same bits as a step
  // of all would give them. The others keep their state, their forces and what was last observed
  // of them; time() and steps() are of steps of all and stay. Groups of lanes without a world of
  // the mask cost nothing, one with some as much as a whole one. The first such call allocates.
  // Recordings keep the state that each comes to, and do not simulate it again.
  int step(std::span<const std::uint8_t> mask, int n = 1, const GoOn& go_on = {});
  // Runs whole steps until the simulated time reaches `clock` s (never past it, up to half a
  // rounding step) and returns how many. `max_steps` keeps a stalled host from spiralling: time
  // beyond it is dropped, but what `go_on` ended is still due. For real-time hosts.
  int step_to(double clock, int max_steps = 8, const GoOn& go_on = {});
  double time() const;         // s, simulated since construction or reset of the whole batch
  std::int64_t steps() const;  // taken since construction or reset of the whole batch

  // ---- State

  // Canonical order [world][item][component], for all worlds or one. Items are those of the field
  // (FieldInfo::item). Sizes must match exactly; throws std::invalid_argument otherwise.
  std::size_t size(Field field) const;
  void read(Field field, Reals out) const;
  void write(Field field, ConstReals in);
  void read(Field field, int world, std::span<double> out) const;
  void write(Field field, int world, std::span<const double> in);

  // In place, without a copy. Here lie centres of mass, not bodies' origins, and principal axes,
  // not bodies' own (read() converts). Writing here neither wakes a world nor
  // clears its impulses, and no listener is notified. Lanes after the last world are unused. The
  // pointer is valid until the Batch is destroyed.
  LaneBlocks lane_blocks(Field field, int kind = 0);
  // Where a world lives in the blocks of its kind: with this index i, lane i % lanes of group
  // i / lanes. With sleep, steps may move it.
  int lane_index(int world) const;

  // Bodies that come and go. A disabled body takes no part in the step: nothing touches it, it
  // keeps its state, and the others have the bits that they would have without it. It costs nothing
  // where it is disabled in all worlds of a group. The first call allocates.
  void set_enabled(int world, BodyId body, bool enabled);
  bool enabled(int world, BodyId body) const;                  // true for fixed bodies
  void spawn(int world, BodyId body, const BodyState& state);  // enabled, with this state

  // Joints that come and go. A disabled joint, or one that broke, holds nothing; enabling it
  // mends it. Its bodies should then satisfy it: what is apart is drawn together.
  // Both bodies wake. The first call allocates.
  void set_joint_enabled(int world, JointId joint, bool enabled);
  bool joint_enabled(int world, JointId joint) const;

  // Sleep (BatchOptions::sleep). A body wakes in the very step in which an awake one comes near
  // it, and at once by a force, an impulse, a written state, or when a body that it slept with is
  // disabled. Sleeping changes nothing that awake bodies compute.
  bool sleeps() const;                        // BatchOptions::sleep
  bool asleep(int world, BodyId body) const;  // false for kinematic and fixed bodies
  bool asleep(int world) const;               // nothing in it moves: it costs nothing
  void wake(int world);
  double awake_fraction() const;     // of worlds
  std::int64_t group_steps() const;  // executed since construction: what a step costs

  // Reset: initial state with a new draw of the scene's jitter. mask has one byte per world,
  // nonzero = reset. An episode counter per world makes each draw new; reset() of all restarts
  // the counters, the clock and the step count, so it repeats the first draw exactly.
  void reset();                                    // repeats
  void reset(std::span<const std::uint8_t> mask);  // draws anew: all ones for every world
  // The first episode of other seeds, one per world; those of worlds that are not reset are
  // ignored. World i of a batch of seed s has the seed s + i until then. With the seeds that worlds
  // have (seed_of()) it repeats their first episode.
  void reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds);
  // To a keyframe of the scenes, by its index in each: as the resets above, and what the keyframe
  // gives instead of what they draw. Where the scene of a world that is reset has no such keyframe
  // they throw std::invalid_argument and reset nothing.
  void reset(KeyframeId keyframe);
  void reset(std::span<const std::uint8_t> mask, KeyframeId keyframe);
  // What every reset from now on gives a field, instead of the scene's value and its jitter:
  // canonical, as write(). Empty: the scene's again. Resets nothing by itself.
  void set_initial(Field field, std::span<const double> in);

  // ---- Inputs

  // Forces and torques (world frame, N, N m; planar torque in z) act on the centre of mass during
  // the next step() call, all its steps, and are cleared after it. Impulses (N s, N m s) change
  // velocities at once. Kinematic bodies ignore them, fixed ones are refused.
  void add_force(int world, BodyId body, const Vec3& force);
  void add_torque(int world, BodyId body, const Vec3& torque);
  void add_force_at(int world, BodyId body, const Vec3& force, const Vec3& point_world);
  void add_impulse(int world, BodyId body, const Vec3& impulse);
  void add_angular_impulse(int world, BodyId body, const Vec3& impulse);
  void add_impulse_at(int world, BodyId body, const Vec3& impulse, const Vec3& point_world);
  bool forces_pending() const;  // some were added since the last step() call

  // Controls (Scene::controls), [world][control]. They act in every step until they are set
  // anew; beyond its range a value counts as the end of the range, and one that is not a number
  // freezes its world (Status::non_finite). A world whose controls change wakes. Buffers of the
  // wrong size throw.
  int controls(int world = 0) const;
  void set_controls(ConstReals in);
  void set_controls(int world, std::span<const double> in);
  void read_controls(Reals out) const;

  // ---- Parameters

  // Numbers of the scene that differ from world to world (Scene::variations), in double and in
  // canonical order: [world][shape of the scene], [world][body], [world][joint of the scene],
  // [world][control] or [world], times info(parameter).numbers. What follows from them (inertia,
  // centre of mass, bounds) is derived anew; a world that is written wakes. Everything can be read.
  // Numbers outside of their declared range, and those of what does not vary that are not what
  // read() gives, throw std::invalid_argument and change nothing.
  std::size_t size(Parameter parameter) const;
  void read(Parameter parameter, std::span<double> out) const;
  void write(Parameter parameter, std::span<const double> in);
  void read(Parameter parameter, int world, std::span<double> out) const;
  void write(Parameter parameter, int world, std::span<const double> in);

  // ---- Observers

  // BatchOptions::observe says which there are. As of the last step of the last step() call, in
  // canonical order. A frozen world has no contacts. A pair that is asleep reports where it touches
  // now, and as impulses what it will wake with, times the substeps. Reading what is not observed
  // throws std::invalid_argument.
  std::size_t size(Observed what) const;
  void read(Observed what, Reals out) const;
  void read(Observed what, int world, std::span<double> out) const;
  std::vector<StepContact> step_contacts(int world) const;
  bool touching(int world, BodyId body) const;  // a contact acted on it; not of fixed bodies
  // A contact acted between these two; of those that Observer::contacts had room for.
  bool touching(int world, BodyId body_a, BodyId body_b) const;
  std::vector<RayHit> ray_hits(int world) const;
  // As many as the batch was made with. Of one world, only origin, direction and length change.
  void set_rays(std::span<const Ray> rays);
  void set_rays(int world, std::span<const Ray> rays);
  // What observers see of states (observed.hpp), at the current one, without a step: after a reset,
  // say.
  void look();

  // ---- Snapshots

  // A restored world goes on bit by bit as the saved one did, whatever the batch: its size,
  // threads, seed, instruction set or place. A restore of all worlds brings their seeds and
  // episodes, too, so that later resets draw what they would have drawn. Plans must have the same
  // fingerprint and the batch the same precision; throws SnapshotError otherwise and changes
  // nothing.
  Snapshot save() const;                                     // all worlds, clock, steps
  Snapshot save(std::span<const int> worlds) const;          // these, in this order
  void restore(const Snapshot& snapshot);                    // of as many worlds as the batch has
  void restore(const Snapshot& snapshot, int from, int to);  // world `from` of it into world `to`
  void copy_world(int from, int to);

  // ---- Results

  Status status(int world) const;
  int lost_worlds() const;
  std::uint64_t hash(int world) const;  // of the state fields in canonical order
  std::uint64_t hash() const;           // of all worlds' hashes in order
  Energy energy(int world) const;       // without what springs of joints hold
  // Both run the collision stages once more on the current state: not for hot loops.
  std::vector<Contact> contacts(int world) const;
  ContactSummary measure_contacts(const GoOn& go_on = {}) const;  // nothing where it ended early
  // Time spent per stage since the last call, summed over threads; empty until profile(true).
  void profile(bool on);
  std::vector<StageTime> take_stage_times();

  // Tells `listener` of every input and every step() call from now on, for as long as
  // another owner holds it. What it does then is no part of the promises of step().
  void listen(std::weak_ptr<BatchListener> listener);

 private:
  friend class Environment;  // environment.hpp: a task around the step
  struct Impl;
  Pimpl<Impl> impl_;
};

}  // namespace manyworlds
