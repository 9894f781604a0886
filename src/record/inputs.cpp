#include "src/record/inputs.hpp"

#include <algorithm>
#include <array>
#include <unordered_set>
#include <utility>

namespace manyworlds::record {

std::int64_t number_count(Input input, const Plan& plan) {
  switch (input) {
    case Input::force:
    case Input::torque:
    case Input::impulse:
    case Input::angular_impulse: return 3;
    case Input::force_at:
    case Input::impulse_at: return 6;
    case Input::spawn: return 13;
    case Input::set_controls: return static_cast<std::int64_t>(plan.scene().controls.size());
    default:
      return is_write(input) ? static_cast<std::int64_t>(plan.numbers(written_field(input))) : 0;
  }
}

void InputLog::add(const Batch& batch, const InputCall& call, int world, std::int64_t step) {
  InputRow row{step, 0, call.input, world, -1, 0, 0};
  if (call.body) row.body = batch.row(call.body, batch.kind_of(call.world));
  if (call.joint) row.body = call.joint.index();
  if (brings_state(call.input)) {
    const Snapshot state = batch.save(std::array{call.world});
    row.begin = static_cast<std::int64_t>(states_.size());
    row.count = static_cast<std::int64_t>(state.size());
    for (const std::byte b : state.bytes()) states_.push_back(static_cast<std::uint8_t>(b));
  } else {
    row.begin = static_cast<std::int64_t>(values_.size());
    row.count = static_cast<std::int64_t>(call.values.size());
    values_.insert(values_.end(), call.values.begin(), call.values.end());
  }
  rows_.push_back(row);
}

void InputLog::stepped(int n) {
  // From the newest to the oldest: a reset clears the forces that were added before it.
  std::unordered_set<std::int32_t> reset;
  for (std::size_t i = rows_.size(); i-- > since_step_;) {
    InputRow& row = rows_[i];
    if (row.input == Input::reset) reset.insert(row.world);
    if (is_force(row.input) && !reset.contains(row.world)) row.call_steps = n;
  }
  since_step_ = rows_.size();
}

bool InputLog::has_open_forces() const {
  return std::any_of(rows_.begin() + static_cast<std::ptrdiff_t>(since_step_), rows_.end(),
                     [](const InputRow& row) { return is_force(row.input); });
}

void InputLog::clear() {
  rows_.clear();
  values_.clear();
  states_.clear();
  since_step_ = 0;
}

void apply(Batch& batch, const InputRow& row, int world, std::span<const double> values,
           std::span<const std::uint8_t> state) {
  const auto vector = [&](std::size_t i) { return Vec3(values[i], values[i + 1], values[i + 2]); };
  const int joint = is_of_joint(row.input) ? row.body : -1;
  const BodyId body =
      row.body >= 0 && joint < 0 ? batch.body_in_row(row.body, batch.kind_of(world)) : BodyId();
  if (is_force(row.input) && row.call_steps == 0) return;
  switch (row.input) {
    case Input::force: batch.add_force(world, body, vector(0)); break;
    case Input::torque: batch.add_torque(world, body, vector(0)); break;
    case Input::force_at: batch.add_force_at(world, body, vector(0), vector(3)); break;
    case Input::impulse: batch.add_impulse(world, body, vector(0)); break;
    case Input::angular_impulse: batch.add_angular_impulse(world, body, vector(0)); break;
    case Input::impulse_at: batch.add_impulse_at(world, body, vector(0), vector(3)); break;
    case Input::enable: batch.set_enabled(world, body, true); break;
    case Input::disable: batch.set_enabled(world, body, false); break;
    case Input::enable_joint: batch.set_joint_enabled(world, JointId(joint), true); break;
    case Input::disable_joint: batch.set_joint_enabled(world, JointId(joint), false); break;
    case Input::spawn:
      batch.spawn(
          world, body,
          {vector(0), Quat(values[3], values[4], values[5], values[6]), vector(7), vector(10)});
      break;
    case Input::wake: batch.wake(world); break;
    case Input::set_controls: batch.set_controls(world, values); break;
#define MW_WRITE(name, ...) case Input::write_##name:
      MW_STATE_FIELDS(MW_WRITE)
      batch.write(written_field(row.input), world, values);
      break;
#undef MW_WRITE
    case Input::reset:
    case Input::restore: {
      std::vector<std::byte> bytes(state.size());
      std::transform(state.begin(), state.end(), bytes.begin(),
                     [](auto b) { return std::byte{b}; });
      batch.restore(Snapshot::from_bytes(std::move(bytes)), 0, world);
      break;
    }
  }
}

bool advance(Batch& batch, std::int64_t& at, std::int64_t step, int& call_steps,
             const GoOn& go_on) {
  while (at < step) {
    const std::int64_t most = call_steps > 0 ? call_steps : 1024;
    const int n = static_cast<int>(std::min(most, step - at));
    const int taken = batch.step(n, go_on);
    at += taken;
    if (taken < n || !go_on()) return false;
    call_steps = 0;
  }
  return true;
}

}  // namespace manyworlds::record
