// BatchListener: is told of everything that changes the worlds of a Batch from outside, so that
// whoever records a run (record.hpp) misses nothing. Nobody listening costs nothing.
#pragma once

#include <cstdint>
#include <span>

#include "manyworlds/ids.hpp"

namespace manyworlds {

class Batch;

// A change of one world, named after the call of Batch that makes it.
enum class Input : std::uint8_t {
  force,                   // values: N (3)
  torque,                  // N m (3)
  force_at,                // N, then the point in the world, m (6)
  impulse,                 // N s (3)
  angular_impulse,         // N m s (3)
  impulse_at,              // N s, then the point in the world, m (6)
  enable,                  // (0)
  disable,                 // (0)
  spawn,                   // position, rotation w x y z, linear and angular velocity (13)
  wake,                    // of the whole world (0)
  write_position,          // canonical, [body][component]
  write_orientation,       // canonical
  write_linear_velocity,   // canonical
  write_angular_velocity,  // canonical
  reset,                   // a new state and no pending forces: reset, or stepped alone (0)
  restore,                 // the world has a new state: restored, copied, or other parameters (0)
  set_controls,            // of the whole world, [control]
  enable_joint,            // (0)
  disable_joint,           // (0)
};
inline constexpr int kInputCount = 19;
const char* to_string(Input input);  // "force", "write_position"

struct InputCall {
  Input input{};
  int world = 0;
  BodyId body = {};  // none, and no joint: the whole world
  JointId joint = {};
  std::span<const double> values = {};  // lives as long as the call
};

class BatchListener {
 public:
  virtual ~BatchListener() = default;
  // Both come after the change, on the caller's thread, and may read the batch but not change it.
  virtual void on_input(const Batch& batch, const InputCall& call) noexcept = 0;
  virtual void on_step(const Batch& batch, int n) noexcept = 0;  // a step() call of n steps
};

}  // namespace manyworlds
