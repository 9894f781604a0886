#include "job.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "scene_source.hpp"
#include "set_option.hpp"
#include "tools/base/interrupt.hpp"

namespace manyworlds::cli {
namespace {

// Steps that cover `seconds`. A quotient that misses a whole number by rounding counts as whole,
// so that 5 s at dt 1/60 are 300 steps.
int steps_for(double seconds, double dt) {
  const double quotient = seconds / dt;
  const double nearest = std::round(quotient);
  const double steps =
      std::abs(quotient - nearest) <= 1e-9 * quotient ? nearest : std::ceil(quotient);
  if (!(steps <= std::numeric_limits<int>::max())) {
    throw InputError(fmt::format("--seconds: {} s at dt {} s is more than {} steps", seconds, dt,
                                 std::numeric_limits<int>::max()));
  }
  return std::max(static_cast<int>(steps), 1);
}

KeyframeId find_keyframe(const Batch& batch, const JobOptions& options) {
  try {
    return batch.keyframe(options.keyframe);
  } catch (const std::invalid_argument& error) {
    throw InputError(std::string("--keyframe: ") + error.what());
  }
}

}  // namespace

Job prepare(const JobOptions& options, std::vector<std::string>* warnings,
            const std::function<void(Scene&)>& change) {
  Scene scene = load_scene(options.scene, options.mjcf, warnings);
  if (options.dt) scene.options.dt = *options.dt;
  if (options.substeps) scene.options.substeps = *options.substeps;
  if (options.solver) scene.options.solver.method = *options.solver;
  if (options.iterations) scene.options.solver.iterations = *options.iterations;
  if (options.joints) scene.options.joint.method = *options.joints;
  for (const std::string& one : options.set) {
    if (const std::string wrong = set_option(scene.options, one); !wrong.empty()) {
      throw InputError("--set: " + wrong);
    }
  }
  if (change) change(scene);
  PlanOptions plan_options;
  plan_options.broad_phase = options.broad_phase;
  plan_options.keep = options.keep;
  const double dt = scene.options.dt;
  Plan plan = compile(scene, plan_options);  // rejects a dt that steps_for() could not divide by
  const int steps = options.seconds ? steps_for(*options.seconds, dt) : options.steps;
  return {options.scene, std::move(plan), steps};
}

Batch make_batch(const Job& job, const JobOptions& options, int worlds, std::uint64_t seed,
                 int threads) {
  BatchOptions batch_options;
  batch_options.worlds = worlds;
  batch_options.threads = threads;
  batch_options.seed = seed;
  batch_options.precision = options.precision;
  batch_options.isa = options.isa;
  batch_options.layout = options.layout;
  batch_options.sleep = options.sleep;
  batch_options.audit_every = options.audit_every;
  if (options.record_contacts > 0) batch_options.observe.what = {Observer::contacts};
  try {
    Batch batch(job.plan, batch_options);
    if (!options.keyframe.empty()) batch.reset(find_keyframe(batch, options));
    return batch;
  } catch (const std::invalid_argument& error) {
    // What is said of this member is about the option of the same name.
    const std::string text = error.what();
    if (text.starts_with("worlds: ")) throw InputError("--" + text);
    throw;
  } catch (const std::system_error& error) {
    throw InputError(std::string("--") + error.what());  // "threads: 600 cannot be started, ..."
  }
}

Timed timed_steps(Batch& batch, int steps, int steps_per_call, Progress* progress,
                  RandomControls controls) {
  using Clock = std::chrono::steady_clock;
  constexpr double kLongest = 0.2;  // s of a call; what it costs to make another is nothing then
  Timed done;
  int most = std::min(steps_per_call, 64);  // steps that a call may have so as not to be too long
  while (done.steps < steps && tools::interrupted() == 0) {
    const int in_call = done.steps % steps_per_call;
    const int n = std::min({steps_per_call - in_call, steps - done.steps, most,
                            controls.steps_until_next(batch.steps())});
    controls.apply(batch, batch.steps());
    const Clock::time_point before = Clock::now();
    batch.step(n);
    const double spent = std::chrono::duration<double>(Clock::now() - before).count();
    done.seconds += spent;
    done.steps += n;
    if (progress != nullptr) progress->advance(n);
    if (n == most && spent < kLongest / 2 && most < steps_per_call) most *= 2;
    if (spent > kLongest && most > 1) most /= 2;
  }
  return done;
}

RandomControls asked_controls(const Batch& batch, const JobOptions& options, std::uint64_t seed) {
  if (!options.random_controls) return {};
  if (batch.plan().scene().controls.empty()) {
    throw InputError(
        fmt::format("--random-controls: scene '{}' has no controls; expected some", options.scene));
  }
  RandomControls controls(batch, seed);
  if (!options.keyframe.empty()) controls.reset_to(find_keyframe(batch, options));
  return controls;
}

}  // namespace manyworlds::cli
