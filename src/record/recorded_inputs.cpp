// The inputs of a recording, and whether they and the samples make one story.
#include <algorithm>

#include "src/record/recording.hpp"

namespace manyworlds {

using record::InputRow;

void Recording::Impl::read_inputs() {
  const record::Handle group = record::open_group(h5, "inputs");
  const hsize_t rows = record::TableReader::open<std::int64_t>(group, "step", {}).rows();
  inputs.resize(rows);
  const auto column = [&]<class T>(const char* name, T InputRow::*member, auto stored) {
    using Stored = decltype(stored);
    const auto table = record::TableReader::open<Stored>(group, name, {});
    table.expect_rows(rows);
    const std::vector<Stored> all = table.template read_all<Stored>();
    for (std::size_t i = 0; i < all.size(); ++i) inputs[i].*member = static_cast<T>(all[i]);
  };
  column("step", &InputRow::step, std::int64_t{});
  column("call_steps", &InputRow::call_steps, std::int32_t{});
  column("input", &InputRow::input, std::uint8_t{});
  column("world", &InputRow::world, std::int32_t{});
  column("body", &InputRow::body, std::int32_t{});
  column("begin", &InputRow::begin, std::int64_t{});
  column("count", &InputRow::count, std::int64_t{});
  input_values = record::TableReader::open<double>(group, "values", {}).read_all<double>();
  input_states =
      record::TableReader::open<std::uint8_t>(group, "states", {}).read_all<std::uint8_t>();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    check_input(i, static_cast<std::int64_t>(input_values.size()),
                static_cast<std::int64_t>(input_states.size()));
  }
}

void Recording::Impl::check_input(std::size_t index, std::int64_t values,
                                  std::int64_t states) const {
  const InputRow& row = inputs[index];
  const auto refuse = [&](const std::string& what) {
    record::fail("input " + std::to_string(index) + ": " + what);
  };
  if (static_cast<int>(row.input) >= kInputCount) {
    refuse("has unknown type " + std::to_string(static_cast<int>(row.input)) + ", must be 0 to " +
           std::to_string(kInputCount - 1));
  }
  const bool whole_world = row.input == Input::wake || row.input == Input::set_controls ||
                           is_write(row.input) || record::brings_state(row.input);
  if (row.world < 0 || row.world >= worlds()) {
    refuse("is for world " + std::to_string(row.world) + " of " + std::to_string(worlds()));
  }
  const Plan& plan = kinds[place(row.world).kind].plan;
  const int bodies = plan.bodies();
  const bool of_joint = record::is_of_joint(row.input);
  const int max_body = of_joint ? static_cast<int>(plan.scene().joints.size()) : bodies;
  if (whole_world ? row.body != -1 : row.body < 0 || row.body >= max_body) {
    refuse("is for " + std::string(of_joint ? "joint " : "body ") + std::to_string(row.body) +
           " of " + std::to_string(max_body));
  }
  if (row.call_steps < 0 || (row.call_steps > 0 && !record::is_force(row.input))) {
    refuse("acts for " + std::to_string(row.call_steps) + " steps, must be " +
           (record::is_force(row.input) ? "0 or more" : "0"));
  }
  const bool brings = record::brings_state(row.input);
  const std::int64_t most = brings ? states : values;
  if (row.begin < 0 || row.count < 0 || row.count > most || row.begin > most - row.count) {
    refuse("has values out of range: " + std::to_string(row.count) + " from " +
           std::to_string(row.begin) + " on, of " + std::to_string(most));
  }
  const std::int64_t wanted = brings ? row.count : record::number_count(row.input, plan);
  if (row.count != wanted) {
    refuse("has " + std::to_string(row.count) + " values, must have " + std::to_string(wanted));
  }
}

// Steps ascend, each sample lies where its count of inputs says, and nothing happens while a step
// call runs.
void Recording::Impl::check_order() const {
  std::size_t next = 0;
  std::int64_t at = 0, busy_until = 0;
  const auto move_to = [&](std::int64_t step, const std::string& item) {
    if (step < at || (step > at && step < busy_until)) {
      record::fail(item + " is at step " + std::to_string(step) + ", must be at " +
                   std::to_string(std::max(at, busy_until)) + " or later");
    }
    at = step;
  };
  for (std::size_t s = 0; s < steps.size(); ++s) {
    const std::string item = "sample " + std::to_string(s);
    const std::int64_t before = inputs_before[s];
    if (before < static_cast<std::int64_t>(next) ||
        before > static_cast<std::int64_t>(inputs.size())) {
      record::fail(item + " comes after " + std::to_string(before) + " inputs of " +
                   std::to_string(inputs.size()));
    }
    for (; next < static_cast<std::size_t>(before); ++next) {
      const InputRow& row = inputs[next];
      move_to(row.step, "input " + std::to_string(next));
      if (row.call_steps == 0) continue;
      const std::int64_t end =
          row.step > INT64_MAX - row.call_steps ? INT64_MAX : row.step + row.call_steps;
      if (busy_until > at && busy_until != end) {
        record::fail("input " + std::to_string(next) +
                     " acts for another number of steps than the input before it");
      }
      busy_until = end;
    }
    move_to(steps[s], item);
  }
}

std::span<const double> Recording::Impl::values(const InputRow& row) const {
  if (record::brings_state(row.input)) return {};
  return std::span(input_values)
      .subspan(static_cast<std::size_t>(row.begin), static_cast<std::size_t>(row.count));
}
std::span<const std::uint8_t> Recording::Impl::state(const InputRow& row) const {
  if (!record::brings_state(row.input)) return {};
  return std::span(input_states)
      .subspan(static_cast<std::size_t>(row.begin), static_cast<std::size_t>(row.count));
}

}  // namespace manyworlds
