// BatchListener: receives every call that changes the worlds of a Batch, so that a recorder
// (record.hpp) is complete. No cost without listeners.
#pragma once

#include <cstdint>
#include <span>

#include "manyworlds/field_table.hpp"
#include "manyworlds/ids.hpp"

namespace manyworlds {

class Batch;

// A change of one world, named after the call of Batch that makes it.
enum class Input : std::uint8_t {
  force,            // values: N (3)
  torque,           // N m (3)
  force_at,         // N, then the point in the world, m (6)
  impulse,          // N s (3)
  angular_impulse,  // N m s (3)
  impulse_at,       // N s, then the point in the world, m (6)
  enable,           // (0)
  disable,          // (0)
  spawn,            // position, rotation w x y z, linear and angular velocity (13)
  wake,             // of the whole world (0)
#define MW_WRITE(name, ...) write_##name,
  MW_STATE_FIELDS(MW_WRITE)  // write_position and so on: canonical, [item][component]
#undef MW_WRITE
  reset,          // a new state and no pending forces: reset, or stepped alone (0)
  restore,        // the world has a new state: restored, copied, or other parameters (0)
  set_controls,   // of the whole world, [control]
  enable_joint,   // (0)
  disable_joint,  // (0)
};
inline constexpr int kInputCount = static_cast<int>(Input::disable_joint) + 1;
const char* to_string(Input input);  // "force", "write_position"

// Conversions between a field and the input that writes it.
inline constexpr Input kFirstWrite = static_cast<Input>(static_cast<int>(Input::wake) + 1);
inline constexpr bool is_write(Input input) { return input >= kFirstWrite && input < Input::reset; }
inline constexpr Input write_of(Field field) {
  return static_cast<Input>(static_cast<int>(kFirstWrite) + static_cast<int>(field));
}
inline constexpr Field written_field(Input write) {
  return static_cast<Field>(static_cast<int>(write) - static_cast<int>(kFirstWrite));
}

struct InputCall {
  Input input{};
  int world = 0;
  BodyId body = {};  // none, and no joint: the whole world
  JointId joint = {};
  std::span<const double> values = {};  // valid during the call
};

class BatchListener {
 public:
  virtual ~BatchListener() = default;
  // Both run after the change on the caller's thread. They may read the batch but not change it.
  virtual void on_input(const Batch& batch, const InputCall& call) noexcept = 0;
  virtual void on_step(const Batch& batch, int n) noexcept = 0;  // a step() call of n steps
};

}  // namespace manyworlds
