#include "lost_worlds.hpp"

#include <algorithm>
#include <cstdio>

#include <fmt/format.h>

#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {

using tools::shell_word;

void LostWorlds::collect(const Batch& batch, std::int64_t first, std::uint64_t seed) {
  for (int world = 0; world < batch.worlds(); ++world) {
    const Status status = batch.status(world);
    if (has(status, Status::contact_overflow)) ++overflowed_;
    if (!manyworlds::lost(status) && !has(status, Status::diverged)) continue;
    lost_.push_back({first + world, seed + static_cast<std::uint64_t>(world), status});
  }
}

std::map<std::string, std::int64_t> LostWorlds::by_reason() const {
  std::map<std::string, std::int64_t> counts;
  for (const LostWorld& world : lost_) ++counts[to_string(world.status)];
  return counts;
}

std::string reproduce_command(const JobOptions& options, int steps, std::uint64_t seed) {
  std::string command = fmt::format("manyworlds run {} --worlds 1 --seed {} --steps {}",
                                    shell_word(options.scene), seed, steps);
  for (const std::string& root : options.mjcf.roots) command += " --mjcf-root " + shell_word(root);
  for (const std::string& limit : options.mjcf.limits)
    command += " --mjcf-limit " + shell_word(limit);
  if (options.dt) command += fmt::format(" --dt {}", *options.dt);
  if (options.substeps) command += fmt::format(" --substeps {}", *options.substeps);
  if (options.solver) command += fmt::format(" --solver {}", to_string(*options.solver));
  if (options.iterations) command += fmt::format(" --iterations {}", *options.iterations);
  if (options.joints) command += fmt::format(" --joints {}", to_string(*options.joints));
  for (const std::string& one : options.set) command += " --set " + shell_word(one);
  if (options.random_controls) command += " --random-controls";
  if (!options.keyframe.empty()) command += " --keyframe " + shell_word(options.keyframe);
  if (options.sleep) command += " --sleep on";
  if (options.audit_every != BatchOptions{}.audit_every) {
    command += fmt::format(" --audit-every {}", options.audit_every);
  }
  if (options.precision != Precision::f32) {
    command += fmt::format(" --precision {}", to_string(options.precision));
  }
  if (options.broad_phase != BroadPhase::automatic) {
    command += " --broad-phase " + option_name(options.broad_phase);
  }
  for (const Feature feature : options.keep)
    command += fmt::format(" --keep {}", to_string(feature));
  return command;
}

void print_lost(const LostWorlds& worlds, const JobOptions& options, int steps, std::size_t most) {
  const std::size_t shown = std::min(most, worlds.lost().size());
  for (std::size_t i = 0; i < shown; ++i) {
    const LostWorld& lost = worlds.lost()[i];
    const char* what = manyworlds::lost(lost.status) ? "lost" : "flagged";
    tools::tell("manyworlds: world {} {} ({}): {}\n", lost.world, what, to_string(lost.status),
                reproduce_command(options, steps, lost.seed));
  }
  if (shown < worlds.lost().size()) {
    tools::tell("manyworlds: and {} more of them\n", worlds.lost().size() - shown);
  }
}

}  // namespace manyworlds::cli
