// `manyworlds run`: the main job. Many worlds of one scene for a while, then a summary.
#include <algorithm>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "job.hpp"
#include "lost_worlds.hpp"
#include "progress.hpp"
#include "recording.hpp"
#include "report.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {
namespace {

using tools::counted, tools::hex, tools::length, tools::with_prefix;

constexpr int kStepsProfiled = 48;  // after the timed ones, for the stage split
constexpr std::size_t kLostShownByRun = 10;

std::string stage_line(const Report& report) {
  std::vector<Report::StageShare> shares = report.stage_split;
  std::stable_sort(shares.begin(), shares.end(),
                   [](const auto& a, const auto& b) { return a.fraction > b.fraction; });
  std::string line;
  for (const Report::StageShare& share : shares) {
    if (share.fraction < 0.005) continue;
    line +=
        fmt::format("{}{} {:.0f} %", line.empty() ? "" : ", ", share.stage, 100 * share.fraction);
  }
  return line.empty() ? "-" : line;
}

std::string lost_line(const LostWorlds& worlds) {
  std::string line = fmt::format("{}", worlds.lost().size());
  for (const auto& [reason, count] : worlds.by_reason()) {
    line +=
        fmt::format("{}{} {}", line.find('(') == std::string::npos ? " (" : ", ", count, reason);
  }
  return worlds.lost().empty() ? line : line + ")";
}

void print_summary(const Report& report, const LostWorlds& worlds, const Batch& batch,
                   double seconds) {
  const auto row = [](const char* name, const std::string& value) {
    fmt::print("  {:<13}{}\n", name, value);
  };
  fmt::print("{}: {} x {}, {:.4g} s simulated each\n", report.scene,
             counted(report.worlds, "world"), counted(report.steps, "step"),
             report.steps * report.dt);
  row("step", fmt::format("dt {:.6g} s, {}, {}", report.dt, counted(report.substeps, "substep"),
                          solver_text(report.solver, report.iterations)));
  row("kernels",
      fmt::format("{}, {}, {} per call", batch.kernel_table(), counted(report.threads, "thread"),
                  counted(report.steps_per_call, "step")));
  row("time", fmt::format("{:.3g} s", seconds));
  row("speed",
      fmt::format("{} world-steps/s, {} body-steps/s", with_prefix(report.world_steps_per_s),
                  with_prefix(report.body_steps_per_s)));
  row("stages", stage_line(report));
  row("memory",
      fmt::format("{:.2f} kB per world", static_cast<double>(report.bytes_per_world) / 1e3));
  row("contacts", fmt::format("{:.1f} points in {:.1f} manifolds per world",
                              report.contacts_per_world, report.manifolds_per_world));
  if (report.sleep) row("awake", fmt::format("{:.1f} % of worlds", 100 * report.awake_fraction));
  row("penetration", fmt::format("{} at most", length(report.max_penetration)));
  if (report.max_joint_gap > 0) {
    row("joint gap", fmt::format("{} at most", length(report.max_joint_gap)));
  }
  row("energy", fmt::format("{:.6g} J per world ({:.6g} kinetic, {:.6g} potential)",
                            report.mean_energy.kinetic + report.mean_energy.potential,
                            report.mean_energy.kinetic, report.mean_energy.potential));
  row("lost worlds", lost_line(worlds));
  row("hash", hex(report.hash));
}

}  // namespace

int run_command(const JobOptions& options) {
  const Job job = prepare(options);
  const std::uint64_t seed = options.seed.value_or(0);
  Batch batch = make_batch(job, options, options.worlds, seed, options.threads);

  const RandomControls controls = asked_controls(batch, options, seed);

  const int call = steps_per_call(options);
  const tools::Interruptible interruptible;
  JobRecorder recorder(batch, options);
  LostDumps dumps(options);
  dumps.watch(batch, 0);
  Timed done;
  {
    Progress progress(options.scene, job.steps);
    done = timed_steps(batch, job.steps, call, &progress, controls);
  }
  dumps.finish();
  const std::string recorded = recorder.finish(batch);
  Report report = measure(batch, job, done.steps, call, done.seconds);
  report.interrupted = tools::interrupt_name();
  LostWorlds worlds;
  worlds.collect(batch, 0, seed);
  if (report.interrupted.empty()) {
    report.stage_split = profile_stages(batch, std::min(job.steps, kStepsProfiled),
                                        options.steps_per_call, controls);
  }

  if (options.json) {
    fmt::print("{}\n", to_json(report).dump(2));
  } else {
    print_summary(report, worlds, batch, done.seconds);
    if (!recorded.empty()) fmt::print("  {:<13}{}\n", "recorded", recorded);
  }
  std::fflush(stdout);  // the lines below come after it on a terminal and in a log
  if (worlds.overflowed() > 0) {
    tools::tell("manyworlds: warning: {} ran out of contact capacity\n",
                counted(worlds.overflowed(), "world"));
  }
  print_lost(worlds, options, done.steps, kLostShownByRun);
  dumps.print();
  int code = worlds.lost().empty() ? kOk : kWorldLost;
  if (!report.interrupted.empty()) {
    tools::tell("manyworlds: interrupted by {} after {} of {}\n", report.interrupted, done.steps,
                counted(job.steps, "step"));
    code = tools::interrupt_code();
  }
  return finish_code(recorder, dumps, code);
}

}  // namespace manyworlds::cli
