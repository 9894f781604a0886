// Batch: N worlds of one or several Plans, and the step.
//
// One SIMD lane holds one world; groups of worlds spread over threads. A world's bits after n
// steps depend only on its Plan, its initial state and its inputs. They do not depend on its lane,
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

// Polled during long calls, on their thread; returning false ends the call early. An exception
// also ends the call, in the same state (steps() counts the steps taken), and reaches the caller.
// The function must not use the object whose call polls it. Empty: no polling.
using GoOn = std::function<bool()>;

class Batch {
 public:
  // Throws std::invalid_argument for invalid options: worlds < 1, threads not within 0 to
  // kMaxThreads or set together with an executor, an ISA that is not available, a value that is
  // not of its enumeration. Also if the worlds need more memory than the machine has; the message
  // states how much. Throws std::system_error if options.threads cannot be started.
  explicit Batch(Plan plan, const BatchOptions& options = {});

  // Worlds of several plans: `worlds` of each, in this order. options.worlds is ignored.
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
  // The methods of plan(kind): items by name, and the row of a body in arrays [body].
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
  int bodies(int world = 0) const;  // with a state (rows of arrays)
  int threads() const;
  Isa isa() const;
  Precision precision() const;
  std::uint64_t seed() const;              // BatchOptions::seed
  std::uint64_t seed_of(int world) const;  // seed() + world, or set by a reset
  int lanes() const;
  std::string kernel_table() const;     // "avx2 f32 x8"
  std::size_t bytes_per_world() const;  // persistent state, mean over worlds
  std::size_t scratch_bytes() const;    // per thread

  // ---- Stepping

  // Steps all worlds n times and returns the number of steps taken. `go_on` is polled between
  // steps about 15 times a second, for hosts that must stay responsive. If it ends the call early,
  // states, inputs, observers and listeners are as after a call with that number of steps.
  // Allocates nothing after the constructor, reset and the first force call. Throws only
  // std::invalid_argument, for n < 0, a clock that is not finite, or max_steps < 0.
  int step(int n = 1, const GoOn& go_on = {});
  // Steps only the worlds of a mask (one byte per world, nonzero = step), with the same bits as a
  // step of all worlds. The other worlds keep their state, forces and observations. time() and
  // steps() count steps of all worlds and do not change. A group of lanes costs nothing if the
  // mask has none of its worlds, else as much as a full group. The first such call allocates.
  // Recordings store the resulting states and do not simulate these steps again.
  int step(std::span<const std::uint8_t> mask, int n = 1, const GoOn& go_on = {});
  // For real-time hosts: runs whole steps until the simulated time reaches `clock` s (never past
  // it, up to half a rounding step) and returns their number. Time beyond `max_steps` steps is
  // dropped, so that a stalled host can catch up. Time that `go_on` cut off remains due.
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

  // In place, without a copy. Positions are of centres of mass and orientations of principal axes,
  // not of the bodies' frames (read() converts). Writing here neither wakes a world nor clears its
  // impulses, and notifies no listener. Lanes after the last world are unused. The pointer is valid
  // until the Batch is destroyed.
  LaneBlocks lane_blocks(Field field, int kind = 0);
  // Index i of a world in the lane blocks of its kind: lane i % lanes of group i / lanes. With
  // sleep, steps may change it.
  int lane_index(int world) const;

  // Disables or enables a body. A disabled body has no contacts and keeps its state; the other
  // bodies have the same bits as without it. It costs nothing if it is disabled in all worlds of a
  // group. The first call allocates.
  void set_enabled(int world, BodyId body, bool enabled);
  bool enabled(int world, BodyId body) const;                  // true for fixed bodies
  void spawn(int world, BodyId body, const BodyState& state);  // enabled, with this state

  // Disables or enables a joint. A disabled or broken joint exerts no impulse; enabling it repairs
  // it. Its bodies should then satisfy it, since it closes gaps (JointOptions). Both bodies wake.
  // The first call allocates.
  void set_joint_enabled(int world, JointId joint, bool enabled);
  bool joint_enabled(int world, JointId joint) const;

  // Sleep (BatchOptions::sleep). A body wakes in the step in which an awake body comes near it. It
  // wakes at once by a force, an impulse, a written state, or if a body of its island is disabled.
  // Sleeping bodies do not change the bits of awake ones.
  bool sleeps() const;                        // BatchOptions::sleep
  bool asleep(int world, BodyId body) const;  // false for kinematic and fixed bodies
  bool asleep(int world) const;               // nothing moves; the world costs nothing
  void wake(int world);
  double awake_fraction() const;     // of worlds
  std::int64_t group_steps() const;  // executed since construction; measures the cost

  // Reset: initial state with a new draw of the scene's jitter. mask has one byte per world,
  // nonzero = reset. A counter of episodes per world makes each draw new. reset() of all worlds
  // restarts the counters, the clock and the step count, so it repeats the first draw exactly.
  void reset();                                    // repeats
  void reset(std::span<const std::uint8_t> mask);  // new draws; all ones: every world
  // Starts the first episode of new seeds, one per world; seeds of worlds that are not reset are
  // ignored. By default world i has the seed BatchOptions::seed + i. The current seeds (seed_of())
  // repeat the first episode.
  void reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds);
  // Reset to a keyframe, by its index in each scene. Values of the keyframe replace drawn ones.
  // If the scene of a world that is reset has no such keyframe, the call throws
  // std::invalid_argument and resets nothing.
  void reset(KeyframeId keyframe);
  void reset(std::span<const std::uint8_t> mask, KeyframeId keyframe);
  // Sets the values that later resets give a field, instead of the scene's value and jitter. Layout
  // as write(). Empty restores the scene's values. Does not reset.
  void set_initial(Field field, std::span<const double> in);

  // ---- Inputs

  // Forces and torques (world frame, N, N m; planar torque in z) act on the centre of mass during
  // all steps of the next step() call and are then cleared. Impulses (N s, N m s) change
  // velocities at once. Kinematic bodies ignore them; fixed bodies throw std::invalid_argument.
  void add_force(int world, BodyId body, const Vec3& force);
  void add_torque(int world, BodyId body, const Vec3& torque);
  void add_force_at(int world, BodyId body, const Vec3& force, const Vec3& point_world);
  void add_impulse(int world, BodyId body, const Vec3& impulse);
  void add_angular_impulse(int world, BodyId body, const Vec3& impulse);
  void add_impulse_at(int world, BodyId body, const Vec3& impulse, const Vec3& point_world);
  bool forces_pending() const;  // forces were added since the last step() call

  // Controls (Scene::controls), [world][control]. They act in every step until they are set again.
  // Values are clamped to their range; a NaN freezes its world (Status::non_finite). A world whose
  // controls change wakes. Buffers of the wrong size throw std::invalid_argument.
  int controls(int world = 0) const;
  void set_controls(ConstReals in);
  void set_controls(int world, std::span<const double> in);
  void read_controls(Reals out) const;

  // ---- Parameters

  // Parameters of the scene that may vary from world to world (Scene::variations), in double and
  // canonical order: [world][shape of the scene], [world][body], [world][joint of the scene],
  // [world][control] or [world], times info(parameter).numbers. Derived values (inertia, centre of
  // mass, bounds) are computed again, and a written world wakes. All parameters can be read.
  // Writing a value outside its declared range throws std::invalid_argument and changes nothing; so
  // does writing a new value to an item that does not vary.
  std::size_t size(Parameter parameter) const;
  void read(Parameter parameter, std::span<double> out) const;
  void write(Parameter parameter, std::span<const double> in);
  void read(Parameter parameter, int world, std::span<double> out) const;
  void write(Parameter parameter, int world, std::span<const double> in);

  // ---- Observers

  // The observers of BatchOptions::observe, after the last step of the last step() call, in
  // canonical order. A frozen world has no contacts. A sleeping pair reports its current contact
  // points and the impulses with which it will wake, times the number of substeps. Reading an
  // observer that was not requested throws std::invalid_argument.
  std::size_t size(Observed what) const;
  void read(Observed what, Reals out) const;
  void read(Observed what, int world, std::span<double> out) const;
  std::vector<StepContact> step_contacts(int world) const;
  bool touching(int world, BodyId body) const;  // a contact acted on it; not for fixed bodies
  // A contact acted between these bodies, among those that Observer::contacts stored.
  bool touching(int world, BodyId body_a, BodyId body_b) const;
  std::vector<RayHit> ray_hits(int world) const;
  // The number of rays is fixed. For one world, only origin, direction and length may change.
  void set_rays(std::span<const Ray> rays);
  void set_rays(int world, std::span<const Ray> rays);
  // Updates the observers of states (observed.hpp) without a step, for example after a reset.
  void look();

  // ---- Snapshots

  // A restored world continues with the bits of the saved world. Batch size, threads, seed,
  // instruction set and the index of the world may differ. Restoring all worlds also restores their
  // seeds and episodes, so that later resets repeat the original draws. Plans must have the same
  // fingerprint and batches the same precision; otherwise the call throws SnapshotError and changes
  // nothing.
  Snapshot save() const;                                     // all worlds, clock, steps
  Snapshot save(std::span<const int> worlds) const;          // these worlds, in this order
  void restore(const Snapshot& snapshot);                    // with as many worlds as the batch
  void restore(const Snapshot& snapshot, int from, int to);  // its world `from` into world `to`
  void copy_world(int from, int to);

  // ---- Results

  Status status(int world) const;
  int lost_worlds() const;
  std::uint64_t hash(int world) const;  // of the state fields in canonical order
  std::uint64_t hash() const;           // of all worlds' hashes in order
  Energy energy(int world) const;       // without springs of joints
  // Both run the collision stages again on the current state, so they cost a part of a step.
  std::vector<Contact> contacts(int world) const;
  ContactSummary measure_contacts(const GoOn& go_on = {}) const;  // empty if go_on ends it
  // Time spent per stage since the last call, summed over threads; empty until profile(true).
  void profile(bool on);
  std::vector<StageTime> take_stage_times();

  // Notifies `listener` of every input and every step() call from now on, as long as
  // another owner holds it. It may allocate and throw, unlike step().
  void listen(std::weak_ptr<BatchListener> listener);

 private:
  friend class Environment;  // environment.hpp: a task around the step
  struct Impl;
  Pimpl<Impl> impl_;
};

}  // namespace manyworlds
