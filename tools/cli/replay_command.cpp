// `manyworlds replay`: simulates a recording again and says whether it does the same.
#include <chrono>
#include <cstdio>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "not_built.hpp"

#ifdef MW_HAVE_RECORD
#include "manyworlds/record.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"
#endif

namespace manyworlds::cli {

#ifdef MW_HAVE_RECORD

namespace {

using tools::counted;

void print_json(const ReplayArguments& arguments, const Recording& recording,
                const ReplayResult& result, bool whole) {
  nlohmann::ordered_json json = {{"file", arguments.file},
                                 {"worlds", result.worlds},
                                 {"samples", result.samples},
                                 {"steps", result.steps},
                                 {"inputs", recording.inputs()},
                                 {"kernels", result.kernel_table},
                                 {"compared", result.compared},
                                 {"different", result.different},
                                 {"lost_worlds", result.lost_worlds},
                                 {"difference", nullptr}};
  if (const auto& d = result.difference) {
    json["difference"] = {
        {"world", d->world}, {"step", d->step}, {"body", d->body.index()}, {"what", d->what}};
  }
  if (!whole) json["interrupted"] = tools::interrupt_name();
  fmt::print("{}\n", json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

// ", body 3 'crate'"
std::string body_name(const Recording& recording, const Difference& difference) {
  if (!difference.body) return {};
  for (int world = 0; world < recording.worlds(); ++world) {
    if (recording.name_of(world) != difference.world) continue;
    for (int kind = 0, first = 0; kind < recording.kinds(); ++kind) {
      first += recording.worlds_of(kind);
      if (world >= first) continue;
      const Plan& plan = recording.plan(kind);
      const std::string& name = plan.scene().at(difference.body).name;
      return fmt::format(", body {}{}", difference.body.index(),
                         name.empty() ? "" : " '" + name + "'");
    }
  }
  return fmt::format(", body {}", difference.body.index());
}

void print_text(const ReplayArguments& arguments, const Recording& recording,
                const ReplayResult& result, double seconds) {
  const auto row = [](const char* name, const std::string& value) {
    fmt::print("  {:<13}{}\n", name, value);
  };
  std::string scenes;
  for (int kind = 0; kind < recording.kinds(); ++kind) {
    scenes += (kind > 0 ? ", " : "") + recording.plan(kind).scene().name;
  }
  fmt::print("{}: {} of {}, {}\n", arguments.file, counted(result.worlds, "world"), scenes,
             counted(result.steps, "step"));
  row("recorded by", recording.origin());
  row("replayed by", result.kernel_table);
  row("inputs", fmt::format("{}", recording.inputs()));
  row("compared",
      fmt::format("hash, status and fields of {} in {}, {} in all", counted(result.worlds, "world"),
                  counted(result.samples, "sample"), result.compared));
  row("time", fmt::format("{:.3g} s", seconds));
  row("lost worlds", fmt::format("{}", result.lost_worlds));
  if (const auto& d = result.difference) {
    row("different", fmt::format("{}", result.different));
    row("first", fmt::format("world {}, step {}{}: {}", d->world, d->step, body_name(recording, *d),
                             d->what));
  } else {
    row("different", "none");
  }
}

}  // namespace

int replay_command(const ReplayArguments& arguments) {
  const Recording recording = Recording::open(arguments.file);
  ReplayOptions options;
  options.isa = arguments.job.isa;
  options.threads = arguments.job.threads;
  options.layout = arguments.job.layout;
  const tools::Interruptible interruptible;
  options.go_on = [] { return tools::interrupted() == 0; };
  const auto before = std::chrono::steady_clock::now();
  const ReplayResult result = replay(recording, options);
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - before;
  const bool whole = result.samples == recording.samples();
  if (arguments.job.json) {
    print_json(arguments, recording, result, whole);
  } else {
    print_text(arguments, recording, result, spent.count());
  }
  if (!whole) {
    std::fflush(stdout);
    tools::tell("manyworlds: interrupted by {} after {} of {}\n", tools::interrupt_name(),
                result.samples, counted(recording.samples(), "sample"));
    return tools::interrupt_code();
  }
  return result.different == 0 ? kOk : kWorldLost;
}

#else

int replay_command(const ReplayArguments&) {
  throw not_built("replay", "recordings", "MW_RECORD=ON");
}

#endif

}  // namespace manyworlds::cli
