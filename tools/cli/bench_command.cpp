// `manyworlds bench`: the standard scenes by one protocol, so that figures can be compared.
//
// Every run starts from reset(), takes the warm-up steps, then the timed ones; the median of the
// repeats counts. Each scene is run with 1 thread and with all, by step(1) calls and by step(k)
// calls. The state is hashed after every run: a speed whose hash is not the one of all other runs
// of that scene is no result, and ends the program with an error. Robots get random controls and
// are reset now and then (random_controls.hpp), outside of the clock.
#include <algorithm>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "manyworlds/scenes.hpp"

#include "commands.hpp"
#include "job.hpp"
#include "lost_worlds.hpp"
#include "progress.hpp"
#include "report.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/median.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {
namespace {

using tools::counted, tools::hex, tools::length, tools::median, tools::with_prefix;

constexpr int kProfiledSteps = 96;
constexpr std::size_t kLostShown = 10;

// Bits that should have been equal were not; what() says which.
class HashMismatch : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

bool is_robot(const scenes::Entry& entry) {
  return entry.make().options.solver.method == Solver::newton;
}

std::vector<std::string> default_scenes() {
  std::vector<std::string> names;
  for (const scenes::Entry& entry : scenes::all()) {
    if (entry.standard || is_robot(entry)) names.emplace_back(entry.name);
  }
  if (std::find(names.begin(), names.end(), "free-flight") == names.end()) {
    names.emplace_back("free-flight");
  }
  return names;
}

// All runs of one scene.
class SceneBench {
 public:
  SceneBench(const BenchOptions& options, const Job& job, Progress& progress)
      : options_(options), job_(job), progress_(progress) {}

  // The median over the repeats. Throws HashMismatch and Interrupted.
  Report time(Batch& batch, int steps_per_call) {
    progress_.set_label(fmt::format("{}, {}, step({})", job_.scene,
                                    counted(batch.threads(), "thread"), steps_per_call));
    controls_ = {};
    if (RandomControls::suit(job_.plan)) controls_ = {batch, options_.job.seed.value_or(0)};
    std::vector<double> seconds;
    for (int repeat = 0; repeat < options_.repeats; ++repeat) {
      warm_up(batch, steps_per_call);
      seconds.push_back(
          timed_steps(batch, job_.steps, steps_per_call, &progress_, controls_).seconds);
      tools::stop_if_interrupted();
      require_same_hash(batch, steps_per_call, repeat);
    }
    Report report = measure(batch, job_, job_.steps, steps_per_call, median(seconds));
    lost_ = LostWorlds();
    lost_.collect(batch, 0, options_.job.seed.value_or(0));
    warm_up(batch, steps_per_call);
    report.stage_split =
        profile_stages(batch, std::min(job_.steps, kProfiledSteps), steps_per_call, controls_);
    tools::stop_if_interrupted();
    return report;
  }

  const LostWorlds& lost() const { return lost_; }

 private:
  void warm_up(Batch& batch, int steps_per_call) {
    batch.reset();
    timed_steps(batch, options_.warm_up, steps_per_call, &progress_, controls_);
    tools::stop_if_interrupted();
  }

  void require_same_hash(const Batch& batch, int steps_per_call, int repeat) {
    const std::uint64_t hash = batch.hash();
    if (!hash_) hash_ = hash;
    if (hash == *hash_) return;
    throw HashMismatch(fmt::format(
        "{}: hash {} with {} and step({}) calls in run {}, but {} in the first run", job_.scene,
        hex(hash), counted(batch.threads(), "thread"), steps_per_call, repeat + 1, hex(*hash_)));
  }

  const BenchOptions& options_;
  const Job& job_;
  Progress& progress_;
  RandomControls controls_;
  std::optional<std::uint64_t> hash_;
  LostWorlds lost_;
};

void print_head(const BenchOptions& options, const Batch& batch) {
  const std::string calls = fmt::format("step({})", options.job.steps_per_call);
  fmt::print("{}, {} of warm-up, {} timed, median of {}; {}\n\n",
             counted(options.job.worlds, "world"), counted(options.warm_up, "step"),
             options.job.steps, counted(options.repeats, "run"), batch.kernel_table());
  fmt::print("{:<15}{:>8}{:>7}{:>22}{:>14}{:>10}{:>12}{:>12}{:>8}{:>8}  {:<16}\n", "", "", "",
             "world-steps/s", "body-steps/s", "contacts", "deepest", "widest", "lost", "worlds",
             "");
  fmt::print("{:<15}{:>8}{:>7}{:>11}{:>11}{:>14}{:>10}{:>12}{:>12}{:>8}{:>8}  {:<16}\n", "scene",
             "threads", "sleep", "step(1)", calls, calls, "/world", "overlap", "joint gap",
             "worlds", "awake", "hash");
}

void print_row(const Report& single, const Report& multiple) {
  fmt::print("{:<15}{:>8}{:>7}{:>11}{:>11}{:>14}{:>10.1f}{:>12}{:>12}{:>8}{:>7.1f}%  {:<16}\n",
             single.scene, single.threads, single.sleep ? "on" : "off",
             with_prefix(single.world_steps_per_s), with_prefix(multiple.world_steps_per_s),
             with_prefix(multiple.body_steps_per_s), single.contacts_per_world,
             length(single.max_penetration), length(single.max_joint_gap), single.lost_worlds,
             100 * single.awake_fraction, hex(single.hash));
  std::fflush(stdout);
}

std::vector<Job> prepare_all(const BenchOptions& options) {
  const std::vector<std::string> names = options.scenes.empty() ? default_scenes() : options.scenes;
  std::vector<Job> jobs;
  for (const std::string& name : names) {
    JobOptions one = options.job;
    one.scene = name;
    jobs.push_back(prepare(one));
  }
  return jobs;
}

// One scene, with sleep or without: a row for 1 thread and one for all. Throws HashMismatch and
// Interrupted.
// Returns whether a world was lost.
bool bench_scene(const BenchOptions& options, const Job& job, Progress& progress, bool& head,
                 nlohmann::ordered_json& list) {
  const JobOptions& job_options = options.job;
  SceneBench bench(options, job, progress);
  int last_threads = 0;
  for (const int threads : {1, job_options.threads}) {
    Batch batch =
        make_batch(job, job_options, job_options.worlds, job_options.seed.value_or(0), threads);
    if (batch.threads() == last_threads) continue;  // a machine with one core
    last_threads = batch.threads();
    if (std::exchange(head, false)) print_head(options, batch);
    const Report single = bench.time(batch, 1);
    list.push_back(to_json(single));
    Report multiple = single;
    if (job_options.steps_per_call > 1) {
      multiple = bench.time(batch, job_options.steps_per_call);
      list.push_back(to_json(multiple));
    }
    progress.erase();
    if (!job_options.json) print_row(single, multiple);
  }
  JobOptions reproduce = job_options;
  reproduce.scene = job.scene;
  reproduce.random_controls = RandomControls::suit(job.plan);
  print_lost(bench.lost(), reproduce, options.warm_up + job.steps, kLostShown);
  return !bench.lost().lost().empty();
}

}  // namespace

int bench_command(const BenchOptions& options) {
  const std::vector<Job> jobs = prepare_all(options);  // every name is checked before the first run

  // Steps of all runs: two thread counts, two kinds of call.
  const std::int64_t runs = 2 * 2 * static_cast<std::int64_t>(options.repeats) *
                            static_cast<std::int64_t>(options.sleep.size());
  std::int64_t work = 0;
  for (const Job& job : jobs) work += runs * (job.steps + options.warm_up);
  Progress progress("bench", work);

  const tools::Interruptible interruptible;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  bool any_lost = false;
  bool head = !options.job.json;
  try {
    for (const Job& job : jobs) {
      for (const bool sleep : options.sleep) {
        BenchOptions one = options;
        one.job.sleep = sleep;
        any_lost = bench_scene(one, job, progress, head, list) || any_lost;
      }
    }
  } catch (const HashMismatch& mismatch) {
    progress.erase();
    tools::tell("manyworlds: {}\n", mismatch.what());
    return kWorldLost;
  } catch (const tools::Interrupted&) {
    progress.erase();
    const std::size_t rows = list.size();
    list.push_back({{"interrupted", tools::interrupt_name()}});
    if (options.job.json) fmt::print("{}\n", list.dump(2));
    std::fflush(stdout);
    tools::tell("manyworlds: interrupted by {} after {}\n", tools::interrupt_name(),
                counted(static_cast<long long>(rows), "measurement"));
    return tools::interrupt_code();
  }
  progress.erase();
  if (options.job.json) fmt::print("{}\n", list.dump(2));
  return any_lost ? kWorldLost : kOk;
}

}  // namespace manyworlds::cli
