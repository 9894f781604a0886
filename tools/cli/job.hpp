// A scene made ready to step as the options ask, and the clock around its steps.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "manyworlds/batch.hpp"
#include "manyworlds/plan.hpp"

#include "options.hpp"
#include "progress.hpp"
#include "tools/base/random_controls.hpp"

namespace manyworlds::cli {

using tools::RandomControls;

struct Job {
  std::string scene;  // as the user wrote it
  Plan plan;
  int steps = 0;  // --steps, or what --seconds comes to
};

// Loads (scene_source.hpp), applies --dt and the like and then `change`, compiles. Throws
// InputError and SceneError.
Job prepare(const JobOptions& options, std::vector<std::string>* warnings = nullptr,
            const std::function<void(Scene&)>& change = {});

// A batch of `worlds` whose world i draws from seed + i. Throws InputError when the machine does
// not have the memory, std::invalid_argument from the library.
Batch make_batch(const Job& job, const JobOptions& options, int worlds, std::uint64_t seed,
                 int threads);

struct Timed {
  int steps = 0;
  double seconds = 0;  // inside step()
};

// Takes `steps` steps in calls of `steps_per_call`, or fewer if it is interrupted. Calls may be
// shorter: the last one, and those that would keep an interrupt waiting. `progress` may be null.
// Calls end where `controls` change; setting them is not timed.
Timed timed_steps(Batch& batch, int steps, int steps_per_call, Progress* progress,
                  RandomControls controls = {});

// Those of --random-controls for a batch of this seed. Throws InputError where there are none.
RandomControls asked_controls(const Batch& batch, const JobOptions& options, std::uint64_t seed);

}  // namespace manyworlds::cli
