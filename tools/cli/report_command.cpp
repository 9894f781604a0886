// `manyworlds report`: each report as a table for people, JSON, and a page that viewer/ makes of
// it.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "built_page.hpp"
#include "commands.hpp"
#include "invariant_world.hpp"
#include "leftovers.hpp"
#include "manyworlds/scenes.hpp"
#include "progress.hpp"
#include "report_page.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/machine.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"
#include "tools/base/version.hpp"
#include "tools/report/accuracy.hpp"
#include "tools/report/invariants.hpp"
#include "tools/report/peer_program.hpp"
#include "tools/report/plan_worth.hpp"
#include "tools/report/report_files.hpp"
#include "tools/report/stability.hpp"
#include "tools/report/throughput.hpp"

namespace manyworlds::cli {
namespace {

using tools::kVersion, tools::machine_line, tools::speed_text;

using Tell = std::function<void(const std::string&, double)>;

// Made before there is anything to write, so that no work is lost to a name that cannot be one.
struct Output {
  std::string name;
  std::optional<std::string> blank;  // the page without a report, where there is one
  report::ReportFiles files;
};

Output output_of(const std::string& name, const ReportOptions& options) {
  std::optional<std::string> blank = read_report_page();
  report::ReportFiles files(options.out, name, blank.has_value());
  tell_of_leftovers(files.leftovers(), {});
  return {name, std::move(blank), std::move(files)};
}

// Runs `measure` with a progress bar.
template <class Measure>
auto run_report(const char* name, Measure measure) {
  Progress progress(name, 1000);
  std::int64_t done = 0;
  return measure(Tell([&](const std::string& next, double share) {
    progress.set_label(next);
    const auto now = static_cast<std::int64_t>(1000 * share);
    progress.advance(now - done);
    done = now;
  }));
}

// Why the files could not be written; empty if they are.
std::string write_files(const Output& output, const nlohmann::ordered_json& json) {
  std::optional<std::string> page;
  if (output.blank) page = page_of(*output.blank, json);
  try {
    output.files.write(json.dump(1) + "\n", page);
    return {};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
}

std::string utc_now() {
  const auto now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  return fmt::format("{:%Y-%m-%dT%H:%MZ}", fmt::gmtime(now));
}

void tell_of_no_page(const report::ReportFiles& files) {
  std::error_code ignored;
  tools::tell("{}; 'manyworlds report page {}' then makes the page{}\n", why_no_page(kReportPage),
              tools::shell_word(files.json().string()),
              std::filesystem::exists(files.page(), ignored)
                  ? fmt::format(". {} is from an earlier report", files.page().string())
                  : "");
}

// Files, and JSON or what `print` prints to standard output, which is not lost with the files.
// Where it was interrupted there are none: those of an older, whole report stay.
template <class Print>
int finish_report(const Output& output, const ReportOptions& options,
                  nlohmann::ordered_json results, Print print) {
  nlohmann::ordered_json json = {{"report", output.name},     {"version", kVersion},
                                 {"machine", machine_line()}, {"date", utc_now()},
                                 {"quick", options.quick},    {"results", std::move(results)}};
  const report::ReportFiles& files = output.files;
  const bool whole = tools::interrupted() == 0;
  std::string failure;
  if (whole) {
    failure = write_files(output, json);
  } else {
    json["interrupted"] = tools::interrupt_name();
  }
  try {
    if (options.json) {
      fmt::print("{}\n", json.dump());
    } else {
      fmt::print("{}\n", machine_line());
      print();
      if (whole && failure.empty()) {
        fmt::print("\n{}{}\n", output.blank ? files.page().string() + '\n' : "",
                   files.json().string());
      }
    }
  } catch (const std::system_error&) {
    if (failure.empty()) throw;  // what comes first is told
  }
  if (!failure.empty()) throw InputError(failure);
  std::fflush(stdout);
  if (whole) {
    if (!output.blank) tell_of_no_page(files);
    return kOk;
  }
  tools::tell("manyworlds: interrupted by {}; {}{} not written\n", tools::interrupt_name(),
              output.blank ? files.page().string() + " and " : "",
              files.json().string() + (output.blank ? " are" : " is"));
  return tools::interrupt_code();
}

void check_names(const char* option, const std::vector<std::string>& wanted,
                 const std::vector<std::string>& known, const char* what) {
  std::string all;
  for (const std::string& name : known) all += (all.empty() ? "" : ", ") + name;
  for (const std::string& name : wanted) {
    if (std::count(known.begin(), known.end(), name) > 0) continue;
    throw InputError(fmt::format("{}: unknown {} '{}'; expected {}", option, what, name, all));
  }
}

std::vector<std::string> scene_names() {
  std::vector<std::string> names;
  for (const scenes::Entry& entry : scenes::all()) names.push_back(entry.name);
  return names;
}

void print_accuracy(const std::vector<report::CaseResult>& results) {
  for (const report::CaseResult& r : results) {
    fmt::print("\n{} {}: {} ({}), after {:g} s\n", r.of.id, r.of.title, r.of.metric, r.of.unit,
               r.seconds);
    fmt::print("  {:<30} {:>5} {:>10} {:>10} {:>14}\n", "method", "", "step, ms", "error",
               "us per world");
    for (const report::Point& p : r.points) {
      fmt::print("  {:<30} {:>5} {:>10.4g} {:>10.3g} {:>14.4g}\n", p.method, to_string(p.precision),
                 1e3 * p.step, p.error, p.microseconds);
    }
  }
}

void print_stability(const std::vector<report::Verdict>& verdicts) {
  std::string id;
  for (const report::Verdict& v : verdicts) {
    if (v.id != id) {
      fmt::print("\n{} {}: {} (at most {:g} {})\n", v.id, v.title, v.criterion, v.limit, v.unit);
    }
    id = v.id;
    fmt::print("  {:<28} {} {:.3g}{}\n", v.setting, v.passed ? "pass" : "FAIL", v.value,
               v.lost > 0 ? fmt::format(", {} worlds lost", v.lost) : "");
  }
}

report::InvariantsOptions invariants_options(const ReportOptions& options) {
  report::InvariantsOptions out;
  for (const std::string& name : options.families) out.families.push_back(report::one_word(name));
  check_names("--families", out.families, report::family_names(), "family or law");
  out.seed = options.seed.value_or(out.seed);
  out.kinds = options.kinds.value_or(options.quick ? 4 : out.kinds);
  out.precision = options.precision;
  for (const auto units : {invariants::Units::similar, invariants::Units::earth}) {
    if (options.units == to_string(units)) out.units = units;
  }
  return out;
}

const char* verdict_of(const report::InvariantRow& row) {
  if (row.passed()) return "pass";
  return row.family.required ? "FAIL" : "not required";
}

void print_invariants(const std::vector<report::InvariantRow>& rows) {
  std::string law;
  for (const report::InvariantRow& r : rows) {
    if (to_string(r.family.law) != law) {
      law = to_string(r.family.law);
      fmt::print("\n{}\n  {:<34} {:<8} {:<4} {:>9} {:>11} {:>14} {:>7}\n", law, "family", "units",
                 "", "broken, %", "worst", "limit", "world");
    }
    fmt::print("  {:<34} {:<8} {:<4} {:>9.3g} {:>11.3g} {:>14} {:>7}  {}{}{}\n",
               report::one_word(r.family.id), to_string(r.options.units),
               to_string(r.options.precision), 100 * r.share(), r.outcome.worst,
               fmt::format("{:.3g}{}", r.limit(), r.family.unit.empty() ? "" : ' ' + r.family.unit),
               r.outcome.worst_world, verdict_of(r),
               r.outcome.silent > 0 ? fmt::format(", {} silent", r.outcome.silent) : "",
               r.outcome.lost > 0 ? fmt::format(", {} lost", r.outcome.lost) : "");
  }
  if (const report::InvariantRow* worst = report::worst_row(rows)) {
    fmt::print("\nTo see the worst world: {}\n", report::command_of(*worst));
  }
}

void print_worth(const std::vector<report::WorthRow>& rows) {
  std::string scene;
  for (const report::WorthRow& r : rows) {
    if (r.scene != scene) fmt::print("\n{}: {}\n", r.scene, speed_text(r.plain));
    scene = r.scene;
    fmt::print("  {:<40} {:>6.2f}  {}\n", r.variant, r.worth,
               !r.holds.empty() ? r.holds
               : r.same_bits    ? "equal bits"
               : r.must_be_same ? "DIFFERENT BITS"
                                : "");
  }
}

void print_throughput(const report::Throughput& result) {
  fmt::print("limits of the machine, one thread: {:.0f} GFLOP/s (float32), {:.0f} GB/s\n",
             result.limits.gflops, result.limits.gigabytes_per_s);
  std::string sweep;
  for (const report::ThroughputRow& r : result.rows) {
    if (r.sweep != sweep) {
      fmt::print("\n{}\n  {:<24} {:<34} {:>10} {:>12} {:>12} {:>10}\n", r.sweep, "scene", "",
                 "worlds", "steps/s", "B per world", "of memory");
    }
    sweep = r.sweep;
    fmt::print("  {:<24} {:<34} {:>10} {:>12} {:>12} {:>9.1f}%\n", r.scene, r.value, r.worlds,
               speed_text(r.world_steps_per_s), r.bytes_per_world, 100 * r.bandwidth_share);
  }
  if (result.peers) fmt::print("{}", report::peers_text(*result.peers));
}

}  // namespace

int report_accuracy_command(const ReportOptions& options) {
  std::vector<std::string> ids;
  for (const report::Case& c : report::accuracy_cases()) ids.push_back(c.id);
  check_names("--cases", options.cases, ids, "case");
  report::AccuracyOptions what;
  what.cases = options.cases, what.quick = options.quick;
  const Output output = output_of("accuracy", options);
  const tools::Interruptible interruptible;
  const auto results =
      run_report("accuracy", [&](const Tell& tell) { return report::run_accuracy(what, tell); });
  return finish_report(output, options, report::to_json(results), [&] { print_accuracy(results); });
}

int report_stability_command(const ReportOptions& options) {
  std::vector<std::string> ids;
  for (const report::Trial& t : report::stability_trials()) ids.push_back(t.id);
  check_names("--cases", options.cases, ids, "case");
  const Output output = output_of("stability", options);
  const tools::Interruptible interruptible;
  const auto verdicts = run_report("stability", [&](const Tell& tell) {
    return report::run_stability({options.cases, options.quick}, tell);
  });
  return finish_report(output, options, report::to_json(verdicts),
                       [&] { print_stability(verdicts); });
}

int report_invariants_command(const ReportOptions& options) {
  const report::InvariantsOptions what = invariants_options(options);
  if (options.world) return invariant_world(what, options);
  const Output output = output_of("invariants", options);
  const tools::Interruptible interruptible;
  const auto rows = run_report(
      "invariants", [&](const Tell& tell) { return report::run_invariants(what, tell); });
  return finish_report(output, options, report::to_json(rows), [&] { print_invariants(rows); });
}

int report_plan_command(const ReportOptions& options) {
  check_names("--scenes", options.scenes, scene_names(), "scene");
  const Output output = output_of("plan", options);
  const tools::Interruptible interruptible;
  const auto rows = run_report("plan", [&](const Tell& tell) {
    return report::run_worth({options.scenes, options.quick}, tell);
  });
  const int code =
      finish_report(output, options, report::to_json(rows), [&] { print_worth(rows); });
  const bool wrong = std::any_of(rows.begin(), rows.end(), [](const report::WorthRow& r) {
    return r.must_be_same && !r.same_bits;
  });
  return code == kOk && wrong ? kWorldLost : code;
}

int report_throughput_command(const ReportOptions& options) {
  check_names("--scenes", options.scenes, scene_names(), "scene");
  if (!options.peers.empty()) report::find_peers(options.peers);  // says early what is wrong
  const Output output = output_of("throughput", options);
  const tools::Interruptible interruptible;
  const auto result = run_report("throughput", [&](const Tell& tell) {
    return report::run_throughput(
        {options.scenes, options.peers, options.peers_only, options.quick}, tell);
  });
  return finish_report(output, options, report::to_json(result), [&] { print_throughput(result); });
}

}  // namespace manyworlds::cli
