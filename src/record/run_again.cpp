#include "src/record/run_again.hpp"

#include <string>
#include <utility>
#include <vector>

#include "src/base/asked.hpp"
#include "src/record/recording.hpp"

namespace manyworlds::record {
namespace {

// Room that a batch takes per byte of its snapshot, at most: a file that asks for more lies.
constexpr std::size_t kMaxBytesPerByte = 64;
constexpr std::size_t kFreeBytes = std::size_t{1} << 26;

}  // namespace

Batch batch_of(const Recording& given, const ReplayOptions& options) {
  const Recording::Impl& recording = given.impl();
  std::vector<Batch::Kind> kinds;
  std::size_t bytes = 0;
  for (const auto& kind : recording.kinds) {
    kinds.push_back({kind.plan, static_cast<int>(kind.worlds.size())});
    bytes += kind.plan.report().bytes_per_world * kind.worlds.size();
  }
  if (bytes > kFreeBytes && bytes / kMaxBytesPerByte > recording.start.size()) {
    throw RecordError("the snapshot has " + std::to_string(recording.start.size()) +
                      " bytes, its worlds need about " + std::to_string(bytes));
  }
  BatchOptions batch;
  batch.threads = options.threads;
  batch.isa = options.isa;
  batch.layout = options.layout;
  batch.precision = recording.precision;
  batch.sleep = recording.sleep;
  return Batch(std::move(kinds), batch);
}

std::int64_t run_again(const Recording& recording, Batch& batch, const GoOn& go_on,
                       const std::function<void(std::int64_t sample)>& at_sample) {
  const Recording::Impl& all = recording.impl();
  std::int64_t at = 0;
  int call_steps = 0;
  std::size_t next = 0;
  Asked asked(go_on);
  bool goes_on = true;
  const GoOn ask = [&] { return goes_on = asked(); };
  try {
    batch.restore(all.start);
    for (std::int64_t sample = 0; sample < recording.samples() && ask(); ++sample) {
      const auto before =
          static_cast<std::size_t>(all.inputs_before[static_cast<std::size_t>(sample)]);
      for (; next < before && goes_on; ++next) {
        const InputRow& row = all.inputs[next];
        if (!advance(batch, at, row.step, call_steps, ask)) break;
        apply(batch, row, row.world, all.values(row), all.state(row));
        if (row.call_steps > 0) call_steps = row.call_steps;
      }
      if (!goes_on || !advance(batch, at, recording.step(sample), call_steps, ask)) break;
      at_sample(sample);
    }
  } catch (const SnapshotError& error) {
    throw RecordError(error.what());
  } catch (const std::invalid_argument& error) {
    throw RecordError("input " + std::to_string(next) + ": " + error.what());
  }
  asked.rethrow();  // as it is: it is no fault of the recording
  return at;
}

}  // namespace manyworlds::record
