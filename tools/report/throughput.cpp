#include "tools/report/throughput.hpp"
#include "tools/base/interrupt.hpp"

#include <algorithm>
#include <chrono>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "manyworlds/scenes.hpp"
#include "tools/base/machine.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::report {
namespace {

struct Job {
  std::string sweep, scene, value;
  BatchOptions options;
  bool profiled = false;
};

Scene scene_of(const std::string& name) {
  if (const auto sized = scenes::sized(name)) return *sized;
  return scenes::find(name)->make();
}

// The fastest of three runs or more, all of the same steps: what worlds do changes with time.
ThroughputRow measure(const Job& job, const Limits& limits, bool quick) {
  using Clock = std::chrono::steady_clock;
  constexpr int kWarmUp = 60;
  const int steps = quick ? 15 : 60;
  const double wanted = quick ? 0.03 : 0.2;  // s
  Batch batch(compile(scene_of(job.scene)), job.options);
  double best = 1e300, total = 0;
  for (int i = 0; i < 3 || (total < wanted && i < 100); ++i) {
    batch.reset();
    batch.step(kWarmUp);
    const auto start = Clock::now();
    batch.step(steps);
    const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
    best = std::min(best, seconds / steps), total += seconds;
    tools::stop_if_interrupted();
  }

  ThroughputRow row;
  row.sweep = job.sweep, row.scene = job.scene, row.value = job.value;
  row.worlds = batch.worlds(), row.threads = batch.threads();
  row.world_steps_per_s = batch.worlds() / best;
  row.body_steps_per_s = row.world_steps_per_s * batch.bodies(0);
  row.bytes_per_world = batch.bytes_per_world();
  row.bandwidth_share = 2e-9 * static_cast<double>(row.bytes_per_world) * row.world_steps_per_s /
                        limits.gigabytes_per_s;
  if (job.profiled) {
    batch.profile(true);
    batch.step(15);
    double sum = 0;
    const std::vector<StageTime> times = batch.take_stage_times();
    for (const StageTime& t : times) sum += t.seconds;
    for (const StageTime& t : times) row.stages.emplace_back(t.stage, t.seconds / sum);
  }
  batch.reset();
  batch.step(kWarmUp);
  row.hash = batch.hash();
  return row;
}

// A build need not have every kernel in float64 on every instruction set.
bool has_kernels(Isa isa, Precision precision) {
  BatchOptions options;
  options.isa = isa, options.precision = precision, options.threads = 1;
  try {
    return Batch(compile(scenes::find("ball2d")->make()), options).isa() == isa;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

std::vector<Job> jobs_of(const ThroughputOptions& options) {
  std::vector<Job> out;
  const std::vector<std::string> names =
      options.scenes.empty()
          ? std::vector<std::string>{"bin-spheres", "stack10", "chain3d", "ball2d"}
          : options.scenes;
  const auto add = [&](std::string sweep, std::string scene, std::string value, int worlds) {
    Job job{std::move(sweep), std::move(scene), std::move(value), {}, false};
    job.options.worlds = worlds, job.options.threads = 1;
    out.push_back(std::move(job));
    return &out.back();
  };
  for (const std::string& name : names) {
    for (int worlds = 16; worlds <= (options.quick ? 1024 : 65536);
         worlds *= options.quick ? 8 : 4) {
      add("worlds", name, std::to_string(worlds), worlds)->profiled = worlds == 1024;
    }
  }
  const int cpus = tools::usable_cpus();
  for (const std::string& name : names) {
    for (int threads = 1; threads <= cpus;
         threads = threads < cpus ? std::min(2 * threads, cpus) : cpus + 1) {
      add("threads", name, std::to_string(threads), 1024)->options.threads = threads;
    }
  }
  for (const std::string& name : names) {
    for (const Precision precision : {Precision::f32, Precision::f64}) {
      for (const Isa isa : available_isas()) {
        if (!has_kernels(isa, precision)) continue;
        Job* job = add("instruction set and precision", name,
                       fmt::format("{} {}", to_string(isa), to_string(precision)), 1024);
        job->options.isa = isa, job->options.precision = precision;
      }
    }
  }
  for (const int bodies :
       options.quick ? std::vector{1, 20, 300} : std::vector{1, 5, 20, 64, 100, 300, 1000, 5000}) {
    add("bodies per world", "bin-spheres:" + std::to_string(bodies), std::to_string(bodies),
        std::max(16, 8192 / bodies));
  }
  return out;
}

}  // namespace

// Throws Interrupted; what was measured until then is in `out`.
static void run_sweeps(const ThroughputOptions& options,
                       const std::function<void(const std::string&, double)>& tell,
                       Throughput& out) {
  tell("limits of the machine", 0);
  out.limits = measure_limits();
  const std::vector<Job> jobs = options.peers_only ? std::vector<Job>() : jobs_of(options);
  const double sweeps = options.peers.empty() ? 1 : options.peers_only ? 0 : 0.3;  // of the work
  for (const Job& job : jobs) {
    tell(job.sweep + ' ' + job.scene + ' ' + job.value,
         sweeps * static_cast<double>(out.rows.size()) / static_cast<double>(jobs.size()));
    out.rows.push_back(measure(job, out.limits, options.quick));
  }
  if (!options.peers.empty()) {
    out.peers.emplace();
    run_peers(
        {options.peers, options.scenes, options.quick},
        [&](const std::string& what, double share) { tell(what, sweeps + (1 - sweeps) * share); },
        *out.peers);
  }
}

Throughput run_throughput(const ThroughputOptions& options,
                          const std::function<void(const std::string&, double)>& tell) {
  Throughput out;
  try {
    run_sweeps(options, tell, out);
  } catch (const tools::Interrupted&) {
  }
  return out;
}

nlohmann::ordered_json to_json(const Throughput& result) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const ThroughputRow& r : result.rows) {
    nlohmann::ordered_json stages = nlohmann::ordered_json::object();
    for (const auto& [stage, share] : r.stages) stages[stage] = share;
    rows.push_back({{"sweep", r.sweep},
                    {"scene", r.scene},
                    {"value", r.value},
                    {"worlds", r.worlds},
                    {"threads", r.threads},
                    {"world_steps_per_s", r.world_steps_per_s},
                    {"body_steps_per_s", r.body_steps_per_s},
                    {"bytes_per_world", r.bytes_per_world},
                    {"bandwidth_share", r.bandwidth_share},
                    {"stage_split", stages},
                    {"hash", tools::hex(r.hash)}});
  }
  nlohmann::ordered_json out = {{"gflops", result.limits.gflops},
                                {"gigabytes_per_s", result.limits.gigabytes_per_s},
                                {"rows", rows}};
  if (result.peers) {
    const Peers& p = *result.peers;
    out["peer_protocol"] = {
        {"worlds", p.worlds}, {"steps", p.steps}, {"rounds", p.rounds}, {"long_visit", kLongVisit}};
    out["peers"] = nlohmann::ordered_json::array();
    for (const PeerScene& scene : p.scenes) out["peers"].push_back(to_json(scene));
    out["peer_means"] = to_json(means_of(p));
    out["peer_failures"] = p.failures;
  }
  return out;
}

}  // namespace manyworlds::report
