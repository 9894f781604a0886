// WorldsBase: all worlds of one kind (one Plan), whatever their number type: what a Batch reads,
// writes and asks of single worlds. Worlds count from 0 within the kind, bodies are rows of its
// state. The caller has checked indices and sizes.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

#include "manyworlds/batch.hpp"

namespace manyworlds {

class WorldsBase {
 public:
  virtual ~WorldsBase() = default;

  virtual void restart() = 0;                             // all worlds, first episode
  virtual void reset(int world) = 0;                      // next episode
  virtual void reset(int world, std::uint64_t seed) = 0;  // the first episode of this seed
  // Where the world begins from now on, instead of the scene's value and its jitter; canonical. Of
  // all worlds or of none (nullptr).
  virtual void set_initial(Field field, int world, const double* in) = 0;

  // State of one world, canonical: [body][component].
  virtual void read(Field field, int world, float* out) const = 0;
  virtual void read(Field field, int world, double* out) const = 0;
  virtual void write(Field field, int world, const float* in) = 0;
  virtual void write(Field field, int world, const double* in) = 0;
  virtual LaneBlocks lane_blocks(Field field) const = 0;
  virtual int lane_index_of(int world) const = 0;
  virtual Vec3 center_of_mass(int world, int body) const = 0;  // m, world

  // Forces (N, N m) act until they are cleared; impulses (N s, N m s) at once.
  virtual void add_force(int world, int body, const Vec3& force, const Vec3& torque) = 0;
  virtual void add_impulse(int world, int body, const Vec3& impulse, const Vec3& angular) = 0;
  virtual bool forced() const = 0;  // forces were added since they were all cleared
  // Of `count` worlds, one after the other. What a control is set to counts within its range.
  virtual void set_controls(int first, int count, const float* in) = 0;
  virtual void set_controls(int first, int count, const double* in) = 0;
  virtual void read_controls(int first, int count, float* out) const = 0;
  virtual void read_controls(int first, int count, double* out) const = 0;

  virtual bool enabled(int world, int body) const = 0;
  virtual void set_enabled(int world, int body, bool enabled) = 0;
  virtual void spawn(int world, int body, const BodyState& state) = 0;
  virtual bool joint_enabled(int world, int joint) const = 0;
  virtual void set_joint_enabled(int world, int joint, bool enabled) = 0;
  virtual bool asleep(int world, int body) const = 0;
  virtual bool resting(int world) const = 0;  // nothing in it moves
  virtual void wake(int world) = 0;

  // Numbers of the scene, one world's, canonical: [scene's shape], [state body] or the world's one,
  // times the numbers of each. check() says what is wrong with them; empty: nothing.
  virtual std::size_t parameter_size(Parameter parameter) const = 0;
  virtual void read(Parameter parameter, int world, double* out) const = 0;
  virtual double number(Parameter parameter, int world, std::size_t item) const = 0;  // of these
  virtual std::string check(Parameter parameter, int world, const double* in) const = 0;
  virtual void write(Parameter parameter, int world, const double* in) = 0;
  // One of them that varies and is not drawn, kept within its range, from the world's next reset
  // on; where it is not a number, the scene's own.
  virtual void set_next(Parameter parameter, int world, std::size_t item, double value) = 0;

  // A world as bytes (snapshot_format.hpp), and what its next reset draws from.
  virtual std::size_t world_bytes() const = 0;
  virtual void write_world(int world, std::byte* to) const = 0;
  virtual void read_world(int world, const std::byte* from) = 0;
  virtual std::string check_world(const std::byte* from) const = 0;
  virtual void copy_world(int from, int to) = 0;
  virtual std::uint32_t episode(int world) const = 0;
  virtual void set_episode(int world, std::uint32_t episode) = 0;
  virtual std::uint64_t seed(int world) const = 0;
  virtual void set_seed(int world, std::uint64_t seed) = 0;

  virtual Status status(int world) const = 0;
  virtual std::uint64_t hash(int world) const = 0;
  virtual Energy energy(int world) const = 0;
  virtual std::size_t bytes() const = 0;  // of persistent state, all worlds
};

}  // namespace manyworlds
