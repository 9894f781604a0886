// Inputs as they are kept: a row each, their numbers and the states that they brought beside them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "manyworlds/batch.hpp"

namespace manyworlds::record {

struct InputRow {
  std::int64_t step = 0;        // taken before it, since the recording began
  std::int32_t call_steps = 0;  // forces: n of the step(n) call in which they act; 0: they never do
  Input input{};
  std::int32_t world = 0;
  std::int32_t body = -1;  // row of the body, or index of the joint; -1: the whole world
  std::int64_t begin = 0;  // first of its numbers, or first byte of its state
  std::int64_t count = 0;  // of them
};

inline bool is_force(Input input) {
  return input == Input::force || input == Input::torque || input == Input::force_at;
}
// Comes with the whole state of the world after it.
inline bool brings_state(Input input) { return input == Input::reset || input == Input::restore; }
inline bool is_of_joint(Input input) {
  return input == Input::enable_joint || input == Input::disable_joint;
}
// How many numbers come with it, for a world of this plan.
std::int64_t number_count(Input input, const Plan& plan);

inline constexpr std::size_t kRowsInMemory = 4096;

class InputLog {
 public:
  // Adds a call that `batch` told of, as one of world `world` of the recording.
  void add(const Batch& batch, const InputCall& call, int world, std::int64_t step);
  void stepped(int n);  // a step(n) call came after them
  void clear();

  // Whether a force waits for the step call in which it acts.
  bool has_open_forces() const;

  const std::vector<InputRow>& rows() const { return rows_; }
  const std::vector<double>& values() const { return values_; }
  const std::vector<std::uint8_t>& states() const { return states_; }

 private:
  std::vector<InputRow> rows_;
  std::vector<double> values_;
  std::vector<std::uint8_t> states_;
  std::size_t since_step_ = 0;  // first row since the last step call
};

// Makes the call again, on world `world` of `batch`. `values` are its numbers, `state` the bytes of
// a Snapshot. Throws what Batch throws, and SnapshotError.
void apply(Batch& batch, const InputRow& row, int world, std::span<const double> values,
           std::span<const std::uint8_t> state);

// Steps to `step` from `at`, in one call while forces act for `call_steps` steps and in few calls
// otherwise. False where it was ended early.
bool advance(
    Batch& batch, std::int64_t& at, std::int64_t step, int& call_steps,
    const GoOn& go_on = [] { return true; });

}  // namespace manyworlds::record
