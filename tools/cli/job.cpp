#include "job.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "scene_source.hpp"

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

// The kernel would grant the memory and kill the program later.
void require_memory(const Job& job, const JobOptions& options, int worlds) {
  const double scale = options.precision == Precision::f64 ? 2.0 : 1.0;
  const double needed = static_cast<double>(job.plan.report().bytes_per_world) * scale * worlds;
  const double present =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  if (present > 0 && needed > present) {
    throw InputError(
        fmt::format("--worlds: {} worlds of '{}' need {:.1f} GB, the machine has {:.1f} GB", worlds,
                    job.scene, needed / 1e9, present / 1e9));
  }
}

}  // namespace

Job prepare(const JobOptions& options) {
  Scene scene = load_scene(options.scene);
  if (options.dt) scene.options.dt = *options.dt;
  if (options.substeps) scene.options.substeps = *options.substeps;
  if (options.solver) scene.options.solver = *options.solver;
  if (options.iterations) scene.options.iterations = *options.iterations;
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
  require_memory(job, options, worlds);
  BatchOptions batch_options;
  batch_options.worlds = worlds;
  batch_options.threads = threads;
  batch_options.seed = seed;
  batch_options.precision = options.precision;
  batch_options.isa = options.isa;
  batch_options.layout = options.layout;
  batch_options.sleep = options.sleep;
  return Batch(job.plan, batch_options);
}

double timed_steps(Batch& batch, int steps, int steps_per_call, Progress* progress) {
  using Clock = std::chrono::steady_clock;
  Clock::duration spent{};
  for (int done = 0; done < steps;) {
    const int n = std::min(steps_per_call, steps - done);
    const Clock::time_point before = Clock::now();
    batch.step(n);
    spent += Clock::now() - before;
    done += n;
    if (progress != nullptr) progress->advance(n);
  }
  return std::chrono::duration<double>(spent).count();
}

}  // namespace manyworlds::cli
