// What was recorded, simulated again from its first snapshot and its inputs.
#pragma once

#include <cstdint>
#include <functional>

#include "manyworlds/record.hpp"

namespace manyworlds::record {

// A batch of the recording's plans and worlds. Throws RecordError, and what Batch throws.
Batch batch_of(const Recording& recording, const ReplayOptions& options);

// Takes `batch` from the first sample to the last, calling `at_sample` at each; returns the steps
// taken. Throws RecordError where snapshots or inputs do not fit.
std::int64_t run_again(const Recording& recording, Batch& batch, const GoOn& go_on,
                       const std::function<void(std::int64_t sample)>& at_sample);

}  // namespace manyworlds::record
