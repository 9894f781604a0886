// What stands behind a Batch: the kinds of world in one number type, stepped by one executor.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "src/api/observations.hpp"
#include "src/dispatch/kernels.hpp"
#include "src/state/worlds.hpp"
#include "src/step/for_each_group.hpp"
#include "src/step/group_visitor.hpp"
#include "src/step/pipeline.hpp"

namespace manyworlds {

// The number type's side of a Batch. World and body indices were checked by the caller.
class BatchCore {
 public:
  virtual ~BatchCore() = default;
  // The visitor, of the batch's number type, may be null. `only`: the mask of the worlds that are
  // to step; empty: all. Forces act until end_steps().
  virtual void step(Executor& executor, int n, const Visit& visit = {},
                    std::span<const std::uint8_t> only = {}) = 0;
  virtual void end_steps(std::span<const std::uint8_t> only = {}) = 0;
  // Lets the visitor know that the worlds of this mask begin, after resetting them if it is told
  // to. Of batches of one kind, without sleep.
  virtual void begin(Executor& executor, std::span<const std::uint8_t> worlds, bool reset,
                     GroupVisitor& visitor) = 0;
  virtual void restart() = 0;
  virtual void reset(int kind, int world) = 0;
  virtual void reset(int kind, int world, std::uint64_t seed) = 0;  // its first episode
  virtual void read(Field field, int kind, int world, float* out) const = 0;
  virtual void read(Field field, int kind, int world, double* out) const = 0;
  virtual void write(Field field, int kind, int world, const float* in) = 0;
  virtual void write(Field field, int kind, int world, const double* in) = 0;
  virtual LaneBlocks lane_blocks(Field field, int kind) const = 0;
  virtual int slot(int kind, int world) const = 0;
  virtual void set_initial(Field field, int kind, int world, const double* in) = 0;
  virtual std::size_t parameter_size(Parameter parameter, int kind) const = 0;
  virtual void read(Parameter parameter, int kind, int world, double* out) const = 0;
  virtual std::string check(Parameter parameter, int kind, int world, const double* in) const = 0;
  virtual void write(Parameter parameter, int kind, int world, const double* in) = 0;
  virtual void set_controls(int kind, int first, int count, const float* in) = 0;
  virtual void set_controls(int kind, int first, int count, const double* in) = 0;
  virtual void read_controls(int kind, int first, int count, float* out) const = 0;
  virtual void read_controls(int kind, int first, int count, double* out) const = 0;
  virtual void add_force(int kind, int world, int body, const Vec3& f, const Vec3& torque) = 0;
  virtual void add_impulse(int kind, int world, int body, const Vec3& p, const Vec3& l) = 0;
  virtual bool forced() const = 0;
  virtual Vec3 center_of_mass(int kind, int world, int body) const = 0;
  virtual void set_enabled(int kind, int world, int body, bool enabled) = 0;
  virtual bool enabled(int kind, int world, int body) const = 0;
  virtual void set_joint_enabled(int kind, int world, int joint, bool enabled) = 0;
  virtual bool joint_enabled(int kind, int world, int joint) const = 0;
  virtual void spawn(int kind, int world, int body, const BodyState& state) = 0;
  virtual bool asleep(int kind, int world, int body) const = 0;
  virtual bool resting(int kind, int world) const = 0;
  virtual void wake(int kind, int world) = 0;
  virtual std::int64_t group_steps() const = 0;
  virtual std::size_t world_bytes(int kind) const = 0;
  virtual std::uint32_t episode(int kind, int world) const = 0;
  virtual void set_episode(int kind, int world, std::uint32_t episode) = 0;
  virtual std::uint64_t seed(int kind, int world) const = 0;
  virtual void set_seed(int kind, int world, std::uint64_t seed) = 0;
  virtual void write_world(int kind, int world, std::byte* to) const = 0;
  virtual std::string check_world(int kind, const std::byte* from) const = 0;
  virtual void read_world(int kind, int world, const std::byte* from) = 0;
  virtual void copy_world(int kind, int from, int to) = 0;
  virtual Status status(int kind, int world) const = 0;
  virtual std::uint64_t hash(int kind, int world) const = 0;
  virtual Energy energy(int kind, int world) const = 0;
  virtual std::vector<Contact> contacts(int kind, int world) const = 0;
  virtual Observations* observations() = 0;   // nullptr: nothing is observed
  virtual void look(Executor& executor) = 0;  // at the current state
  virtual void look_again() = 0;              // at the next step also at what rests
  // Of dense slots, over all groups, current state.
  virtual double occupancy(int kind, const GoOn& go_on) const = 0;
  virtual std::size_t bytes() const = 0;
  virtual std::size_t scratch_bytes() const = 0;
  virtual int lanes() const = 0;
  virtual Isa isa() const = 0;
  virtual void profile(bool on) = 0;
  virtual std::vector<StageTime> take_stage_times() = 0;
};

std::unique_ptr<BatchCore> make_core(const std::vector<Batch::Kind>& kinds,
                                     const BatchOptions& options, Isa isa, int threads);

}  // namespace manyworlds
