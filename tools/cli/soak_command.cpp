// `manyworlds soak`: many worlds for many steps from random seeds, to find one that breaks.
#include <algorithm>
#include <cstdio>
#include <random>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "job.hpp"
#include "lost_worlds.hpp"
#include "progress.hpp"
#include "recording.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {
namespace {

using tools::counted, tools::length;

// Worlds that are in memory at a time. A world's bits do not depend on it.
constexpr int kWorldsAtOnce = 1024;
constexpr std::size_t kLostShownBySoak = 20;

void print_text(const LostWorlds& worlds, double seconds, double deepest) {
  fmt::print("  {:<13}{}\n", "time", fmt::format("{:.3g} s", seconds));
  fmt::print("  {:<13}{} at most, at the end\n", "penetration", length(deepest));
  fmt::print("  {:<13}{}\n", "overflowed", worlds.overflowed());
  fmt::print("  {:<13}{}\n", "lost worlds", worlds.lost().size());
  for (const auto& [reason, count] : worlds.by_reason()) {
    fmt::print("    {:<11}{}\n", count, reason);
  }
}

// The lost and flagged worlds, and how to see the first of them again.
void add_lost(nlohmann::ordered_json& json, const LostWorlds& worlds, const JobOptions& options,
              int steps) {
  std::int64_t lost_worlds = 0;
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LostWorld& world : worlds.lost()) {
    lost_worlds += lost(world.status) ? 1 : 0;
    if (list.size() >= kLostShownBySoak) continue;
    list.push_back({{"world", world.world},
                    {"seed", world.seed},
                    {"status", to_string(world.status)},
                    {"command", reproduce_command(options, steps, world.seed)}});
  }
  json["lost_worlds"] = lost_worlds;
  json["diverged_worlds"] = static_cast<std::int64_t>(worlds.lost().size()) - lost_worlds;
  json["first_lost"] = std::move(list);
}

}  // namespace

int soak_command(const JobOptions& options) {
  const Job job = prepare(options);
  // 32 bits are plenty and short enough to type.
  const std::uint64_t seed = options.seed ? *options.seed : std::random_device{}();

  const tools::Interruptible interruptible;
  LostWorlds worlds;
  LostDumps dumps(options);
  double deepest = 0;
  double seconds = 0;
  std::int64_t whole = 0;  // worlds that took all steps
  Timed last;
  std::string kernels;
  int threads = 0;
  {
    const std::int64_t all = options.worlds;
    const std::int64_t batches = (all + kWorldsAtOnce - 1) / kWorldsAtOnce;
    Progress progress(fmt::format("soak {}", options.scene), batches * job.steps);
    for (std::int64_t first = 0; first < all && tools::interrupted() == 0; first += kWorldsAtOnce) {
      const int count = static_cast<int>(std::min<std::int64_t>(kWorldsAtOnce, all - first));
      const std::uint64_t batch_seed = seed + static_cast<std::uint64_t>(first);
      Batch batch = make_batch(job, options, count, batch_seed, options.threads);
      const RandomControls controls = asked_controls(batch, options, batch_seed);
      if (first == 0) {
        kernels = batch.kernel_table();
        threads = batch.threads();
      }
      if (first == 0 && !options.json) {
        fmt::print("{}: {} x {}, seed {}, {}, {}\n", options.scene,
                   counted(options.worlds, "world"), counted(job.steps, "step"), seed, kernels,
                   counted(threads, "thread"));
        std::fflush(stdout);
      }
      dumps.watch(batch, first);
      last = timed_steps(batch, job.steps, options.steps_per_call, &progress, controls);
      seconds += last.seconds;
      if (last.steps == job.steps) whole += count;
      dumps.finish();
      worlds.collect(batch, first, batch_seed);
      deepest = std::max(deepest, batch.measure_contacts().max_penetration);
    }
  }

  if (options.json) {
    nlohmann::ordered_json json = {{"scene", options.scene},
                                   {"worlds", options.worlds},
                                   {"worlds_done", whole},
                                   {"steps", job.steps},
                                   {"seed", seed},
                                   {"kernels", kernels},
                                   {"threads", threads},
                                   {"seconds", seconds},
                                   {"max_penetration_m", deepest},
                                   {"overflowed_worlds", worlds.overflowed()}};
    add_lost(json, worlds, options, job.steps);
    if (tools::interrupted() != 0) json["interrupted"] = tools::interrupt_name();
    fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    print_text(worlds, seconds, deepest);
  }
  std::fflush(stdout);
  print_lost(worlds, options, job.steps, kLostShownBySoak);
  dumps.print();
  int code = worlds.lost().empty() ? kOk : kWorldLost;
  if (tools::interrupted() != 0 && whole < options.worlds) {
    std::string also;
    if (last.steps < job.steps) {
      also = fmt::format(", and {} of the next", counted(last.steps, "step"));
    }
    tools::tell("manyworlds: interrupted by {} after {} of {}{}\n", tools::interrupt_name(), whole,
                counted(options.worlds, "world"), also);
    code = tools::interrupt_code();
  }
  return finish_code(dumps, code);
}

}  // namespace manyworlds::cli
