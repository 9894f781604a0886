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
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "manyworlds/executor.hpp"
#include "manyworlds/fields.hpp"
#include "manyworlds/listener.hpp"
#include "manyworlds/observe.hpp"
#include "manyworlds/pimpl.hpp"
#include "manyworlds/plan.hpp"
#include "manyworlds/snapshot.hpp"

namespace manyworlds {

enum class Precision { f32, f64 };
enum class Isa { scalar, avx2, avx512 };
enum class ContactLayout { automatic, dense, rows };
const char* to_string(Precision precision);
const char* to_string(Isa isa);
const char* to_string(ContactLayout layout);

// Instruction sets that this CPU and this build can run, narrowest first. Never empty.
std::vector<Isa> available_isas();
// What a Batch takes when BatchOptions::isa is empty: MANYWORLDS_ISA, else the widest available.
// Throws std::invalid_argument when MANYWORLDS_ISA names one that is unknown or not available.
Isa default_isa();

inline constexpr int kMaxThreads = 1024;  // of a Batch, its own or its executor's

struct BatchOptions {
  int worlds = 1;
  int threads = 0;         // 0: as many as the process may run on (affinity mask)
  std::uint64_t seed = 0;  // world i draws from seed + i
  Precision precision = Precision::f32;
  std::optional<Isa> isa = std::nullopt;  // default_isa()
  ContactLayout layout = ContactLayout::automatic;
  // Bodies at rest fall asleep, island by island (Options::sleep_speed), and cost little until
  // something wakes them; worlds in which everything sleeps cost nothing.
  bool sleep = false;
  Observers observe = {};                        // what to watch beside the step (observe.hpp)
  std::shared_ptr<Executor> executor = nullptr;  // step on these threads; threads must then be 0
};

// Why a world is lost or what went wrong in it; a set of bits.
enum class Status : std::uint32_t {
  ok = 0,
  non_finite = 1,        // frozen: a number was not finite
  out_of_range = 2,      // frozen: |x| > 1e10 m or |v| > 1e5 m/s
  out_of_bounds = 4,     // a body left Options::bounds; the world still steps
  contact_overflow = 8,  // more contacts than the plan's capacity; the newest were dropped
  joint_broken = 16,     // a joint bore more than it could (Joint::break_force) since the reset
};
inline constexpr Status operator|(Status a, Status b) {
  return static_cast<Status>(static_cast<std::uint32_t>(a) | static_cast<std::uint32_t>(b));
}
inline constexpr bool has(Status set, Status bit) {
  return (static_cast<std::uint32_t>(set) & static_cast<std::uint32_t>(bit)) != 0;
}
inline constexpr bool frozen(Status s) { return has(s, Status::non_finite | Status::out_of_range); }
inline constexpr bool lost(Status s) { return frozen(s) || has(s, Status::out_of_bounds); }
std::string to_string(Status status);  // "ok", "non_finite", "out_of_bounds|contact_overflow"

// Where a body is and how it moves, in the frames of Body.
struct BodyState {
  Vec3 position = Vec3::Zero();          // m
  Quat rotation = Quat::Identity();      // need not be unit
  Vec3 linear_velocity = Vec3::Zero();   // m/s, of the centre of mass
  Vec3 angular_velocity = Vec3::Zero();  // rad/s
};

// Energy of one world at its current state, J. Potential energy is zero at the world's origin.
struct Energy {
  double kinetic = 0;
  double potential = 0;
};

// A state field as the step keeps it, for those who read or write it in place (Batch::lane_blocks):
// component c of body b in lane l of group g is number
//   g group_stride + b body_stride + c component_stride + l
// of data, which points to float or double (Batch::precision()).
struct LaneBlocks {
  void* data = nullptr;  // nullptr: the plan leaves the field out (Feature::orientation)
  int groups = 0, bodies = 0, components = 0, lanes = 0;
  std::size_t group_stride = 0, body_stride = 0, component_stride = 0;  // numbers
};

// What the contacts of the last step looked like, over all worlds (see Batch::measure_contacts).
struct ContactSummary {
  double points_per_world = 0;  // points closer than 4 slop
  double manifolds_per_world = 0;
  double max_penetration = 0;  // m, measured from the shapes at the current state
  double mean_occupancy = 0;   // active lanes / lanes of the dense pair slots, last step
};

// One contact point at the current state, as the next step would see it.
struct Contact {
  BodyId body_a = {}, body_b = {};     // when one is fixed it is body_a
  ShapeId shape_a = {}, shape_b = {};  // of these bodies
  Vec3 normal = Vec3::Zero();          // unit, from A to B, world
  Vec3 point = Vec3::Zero();           // m, world, half way between the surfaces
  double separation = 0;               // m, negative when the shapes overlap
  int feature = 0;                     // which features touch; equal ids persist from step to step
  double normal_impulse = 0;           // N s, what warm starting would carry into the next substep
};

struct StageTime {
  std::string stage = {};
  double seconds = 0;
};

// Asked now and then by a call that takes long, on its thread: false ends the call early. Must not
// throw, nor use what it is asked by.
using GoOn = std::function<bool()>;

class Batch {
 public:
  // Throws std::invalid_argument for options that make no sense (worlds < 1, threads not 0 to
  // kMaxThreads or given beside an executor, an ISA that is not available, a value that an
  // enumeration does not have), and for worlds that need more memory than the machine has; it says
  // how much that is.
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

  // -- shape of the batch
  int worlds() const;
  int kinds() const;
  const Plan& plan(int kind = 0) const;
  // As those of the kind's Plan: the one of a name, and where a body is in arrays [body].
  BodyId body(std::string_view name, int kind = 0) const { return plan(kind).body(name); }
  ShapeId shape(std::string_view name, int kind = 0) const { return plan(kind).shape(name); }
  JointId joint(std::string_view name, int kind = 0) const { return plan(kind).joint(name); }
  ControlId control(std::string_view name, int kind = 0) const { return plan(kind).control(name); }
  int row(BodyId body, int kind = 0) const { return plan(kind).row(body); }
  BodyId body_in_row(int row, int kind = 0) const { return plan(kind).body_in_row(row); }
  int kind_of(int world) const;
  int bodies(int world = 0) const;  // that have a state (rows of arrays)
  int threads() const;
  Isa isa() const;
  Precision precision() const;
  std::uint64_t seed() const;  // BatchOptions::seed
  int lanes() const;
  std::string kernel_table() const;     // "avx2 f32 x8"
  std::size_t bytes_per_world() const;  // persistent state, mean over worlds
  std::size_t scratch_bytes() const;    // per thread

  // -- stepping. Allocates nothing, throws nothing (after the constructor, reset and the first
  // force call), but std::invalid_argument for n < 0, a clock that is not finite, or max_steps < 0.
  void step(int n = 1);
  // Steps the worlds of a mask alone (one byte per world, nonzero = step): the same bits as a step
  // of all would give them. The others keep their state, their forces and what was last observed
  // of them; time() and steps() are of steps of all and stay. Groups of lanes without a world of
  // the mask cost nothing, one with some as much as a whole one. The first such call allocates.
  // Recordings keep the state that each comes to, and do not simulate it again.
  void step(std::span<const std::uint8_t> mask, int n = 1);
  // As these, asking between steps, some 15 times a second, whether to go on: for hosts that want
  // to stay in reach. They return how many steps were taken. The bits are those of one call of so
  // many steps, and so is what inputs, observers and listeners see of it.
  int step(int n, const GoOn& go_on);
  int step(std::span<const std::uint8_t> mask, int n, const GoOn& go_on);
  // Runs whole steps until the simulated time reaches `clock` s (never past it, up to half a
  // rounding step) and returns how many. `max_steps` keeps a stalled host from spiralling: time
  // beyond it is dropped. For real-time hosts.
  int step_to(double clock, int max_steps = 8);
  int step_to(double clock, int max_steps, const GoOn& go_on);  // steps not taken are still due
  double time() const;         // s, simulated since construction or reset of the whole batch
  std::int64_t steps() const;  // taken since construction or reset of the whole batch

  // -- state, canonical order [world][body][component], for all worlds or one.
  // Sizes must match exactly; throws std::invalid_argument otherwise.
  std::size_t size(Field field) const;
  void read(Field field, std::span<float> out) const;
  void read(Field field, std::span<double> out) const;
  void write(Field field, std::span<const float> in);
  void write(Field field, std::span<const double> in);
  void read(Field field, int world, std::span<double> out) const;
  void write(Field field, int world, std::span<const double> in);

  // -- state in place, without a copy. Here lie centres of mass, not bodies' origins, and principal
  // axes, not bodies' own (read() turns one into the other). Whoever writes here neither wakes a
  // world nor forgets its impulses, and is heard of by no listener. Lanes after the last world
  // are nobody's. The pointer is valid until the Batch is destroyed.
  LaneBlocks lane_blocks(Field field, int kind = 0);
  // Where a world lives in the blocks of its kind: lane slot % lanes of group slot / lanes. With
  // sleep, steps may move it.
  int slot(int world) const;

  // -- numbers of the scene that differ from world to world (Scene::variations), in double and in
  // canonical order: [world][shape of the scene], [world][body] or [world], times
  // info(parameter).numbers. What follows from them (inertia, centre of mass, bounds) is derived
  // anew; a world that is written wakes. Everything can be read. Numbers outside of their declared
  // range, and those of what does not vary that are not what read() gives, throw
  // std::invalid_argument and change nothing.
  std::size_t size(Parameter parameter) const;
  void read(Parameter parameter, std::span<double> out) const;
  void write(Parameter parameter, std::span<const double> in);
  void read(Parameter parameter, int world, std::span<double> out) const;
  void write(Parameter parameter, int world, std::span<const double> in);

  // -- inputs. Forces and torques (world frame, N, N m; planar torque in z) act on the centre of
  // mass during the next step() call, all its steps, and are cleared after it. Impulses (N s,
  // N m s) change velocities at once. Kinematic bodies ignore them, fixed ones are refused.
  void add_force(int world, BodyId body, const Vec3& force);
  void add_torque(int world, BodyId body, const Vec3& torque);
  void add_force_at(int world, BodyId body, const Vec3& force, const Vec3& point_world);
  void add_impulse(int world, BodyId body, const Vec3& impulse);
  void add_angular_impulse(int world, BodyId body, const Vec3& impulse);
  void add_impulse_at(int world, BodyId body, const Vec3& impulse, const Vec3& point_world);

  // -- controls (Scene::controls), [world][control]. They act in every step until they are set
  // anew; beyond its range a value counts as the end of the range, and one that is not a number
  // freezes its world (Status::non_finite). A world whose controls change wakes. Buffers of the
  // wrong size throw.
  int controls(int world = 0) const;
  void set_controls(std::span<const float> in);
  void set_controls(std::span<const double> in);
  void set_controls(int world, std::span<const double> in);
  void read_controls(std::span<float> out) const;
  void read_controls(std::span<double> out) const;

  // -- bodies that come and go. A disabled body takes no part in the step: nothing touches it, it
  // keeps its state, and the others have the bits that they would have without it. It costs nothing
  // where it is disabled in all worlds of a group. The first call allocates.
  void set_enabled(int world, BodyId body, bool enabled);
  bool enabled(int world, BodyId body) const;                  // true for fixed bodies
  void spawn(int world, BodyId body, const BodyState& state);  // enabled, with this state

  // -- joints that come and go. A disabled joint, or one that broke, holds nothing; enabling it
  // mends it. Its bodies should then be where it wants them: what is apart is drawn together.
  // Both bodies wake. The first call allocates.
  void set_joint_enabled(int world, JointId joint, bool enabled);
  bool joint_enabled(int world, JointId joint) const;

  // -- sleep (BatchOptions::sleep). A body wakes in the very step in which an awake one comes near
  // it, and at once by a force, an impulse, a written state, or when a body that it slept with is
  // disabled. Sleeping changes nothing that awake bodies compute.
  bool sleeps() const;                        // BatchOptions::sleep
  bool asleep(int world, BodyId body) const;  // false for kinematic and fixed bodies
  bool asleep(int world) const;               // nothing in it moves: it costs nothing
  void wake(int world);
  double awake_fraction() const;     // of worlds
  std::int64_t group_steps() const;  // executed since construction: what a step costs

  // -- reset: initial state with a new draw of the scene's jitter. mask has one byte per world,
  // nonzero = reset. An episode counter per world makes each draw new; reset() of all restarts
  // the counters, the clock and the step count, so it repeats the first draw exactly.
  void reset();
  void reset(std::span<const std::uint8_t> mask);
  // The first episode of other seeds, one per world; those of worlds that are not reset are
  // ignored. World i of a batch of seed s has the seed s + i until then.
  void reset(std::span<const std::uint8_t> mask, std::span<const std::uint64_t> seeds);
  // What every reset from now on gives a field, instead of the scene's value and its jitter:
  // canonical, as write(). Empty: the scene's again. Resets nothing by itself.
  void set_initial(Field field, std::span<const double> in);

  // -- snapshots. A restored world goes on bit by bit as the saved one did, whatever the batch:
  // its size, threads, seed, instruction set or place. A restore of all worlds brings their seeds
  // and episodes, too, so that later resets draw what they would have drawn. Plans must have the
  // same fingerprint and the batch the same precision; throws SnapshotError otherwise and changes
  // nothing.
  Snapshot save() const;                                     // all worlds, clock, steps
  Snapshot save(std::span<const int> worlds) const;          // these, in this order
  void restore(const Snapshot& snapshot);                    // of as many worlds as the batch has
  void restore(const Snapshot& snapshot, int from, int to);  // world `from` of it into world `to`
  void copy_world(int from, int to);

  // -- results
  Status status(int world) const;
  int lost_worlds() const;
  std::uint64_t hash(int world) const;  // of the state fields in canonical order
  std::uint64_t hash() const;           // of all worlds' hashes in order
  Energy energy(int world) const;       // without what springs of joints hold
  // Both run the collision stages once more on the current state: not for hot loops.
  std::vector<Contact> contacts(int world) const;
  ContactSummary measure_contacts() const;
  ContactSummary measure_contacts(const GoOn& go_on) const;  // nothing where it ended early

  // -- observers (BatchOptions::observe), as of the last step of the last step() call, in canonical
  // order. A frozen world has no contacts. A pair that is asleep reports where it touches now, and
  // as impulses what it will wake with, times the substeps. Reading what is not observed throws
  // std::invalid_argument.
  std::size_t size(Observed what) const;
  void read(Observed what, std::span<float> out) const;
  void read(Observed what, std::span<double> out) const;
  void read(Observed what, int world, std::span<double> out) const;
  std::vector<StepContact> step_contacts(int world) const;
  bool touching(int world, BodyId body) const;  // a contact pushed it; not of fixed bodies
  // A contact pushed these two apart; of those that Observer::contacts had room for.
  bool touching(int world, BodyId body_a, BodyId body_b) const;
  std::vector<RayHit> ray_hits(int world) const;
  // As many as the batch was made with. Of one world, only origin, direction and length change.
  void set_rays(std::span<const Ray> rays);
  void set_rays(int world, std::span<const Ray> rays);
  // Motion, coordinates of joints and rays at the current state, without a step: after a reset,
  // say.
  void look();

  // Time spent per stage since the last call, summed over threads; empty until profile(true).
  void profile(bool on);
  std::vector<StageTime> take_stage_times();

  // Tells `listener` of every input and every step() call from now on, for as long as somebody
  // else holds it. What it does then is no part of the promises of step().
  void listen(std::weak_ptr<BatchListener> listener);
  bool forces_pending() const;  // some were added since the last step() call

 private:
  friend class Environment;  // environment.hpp: a task around the step
  struct Impl;
  Pimpl<Impl> impl_;
};

}  // namespace manyworlds
