// `manyworlds compare`: a model's motion and speed beside MuJoCo's, of the same file in the same
// process.
#include "commands.hpp"
#include "not_built.hpp"

#ifdef MW_HAVE_MJCF

#include <algorithm>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/base/interrupt.hpp"
#include "tools/base/machine.hpp"
#include "tools/base/median.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"
#include "tools/compare/paths.hpp"
#include "tools/compare/speed.hpp"
#include "tools/compare/states.hpp"

namespace manyworlds::cli {
namespace {

using tools::counted, tools::hex, tools::median, tools::with_prefix;
using Json = nlohmann::ordered_json;

constexpr int kPaths = 16, kFreePaths = 4;
constexpr int kSpeedWorlds = 1024, kMujocoWorlds = 64, kSpeedSteps = 100, kRounds = 5;
// To what float32 reaches, too, and as far as models for training go.
constexpr compare::Effort kConverged{1e-6}, kFast{1e-6, 1, 5, false};
constexpr const char* kNotCompared =
    "joint-space inertia, bias, passive and actuator forces, constraint rows and their forces: "
    "manyworlds has no such fields; their effects show in qacc, kinetic energy and the next state";

struct Findings {
  std::vector<compare::StateComparison> states;
  std::vector<compare::Parting> paths;
  std::vector<compare::FreePaths> free;  // one, in float64
  std::vector<compare::Speed> speeds;
  std::vector<std::string> failures;
  int done = 0, all = 0;  // comparisons
};

void add_failures(Findings& findings, const std::vector<std::string>& failures) {
  findings.failures.insert(findings.failures.end(), failures.begin(), failures.end());
}

// Fills `findings` comparison by comparison. Throws tools::Interrupted.
void find(const MjcfFiles& files, const CompareOptions& compared, Findings& findings) {
  const JobOptions& options = compared.job;
  compare::Settings settings{compared.tolerance, options.seed.value_or(0)};
  settings.pause = tools::stop_if_interrupted;
  const std::vector<compare::Kernels> all = compare::kernels();
  if (all.empty() || all.front().precision != Precision::f64) {
    // Gates that were not evaluated would hold.
    throw not_built("compare", "float64", "MW_KERNELS=");
  }
  compare::Pair pair(files, settings);
  for (const std::string& warning : pair.warnings()) {
    tools::tell("manyworlds: warning: {}\n", warning);
  }
  // States, paths and both speeds of each, and the paths without contacts.
  findings.all = static_cast<int>(all.size()) * (compared.no_speed ? 2 : 4) + 1;
  for (const compare::Kernels& kernels : all) {
    const auto samples = compare::draw_samples(pair, kernels.precision, options.worlds);
    findings.states.push_back(compare::compare_states(pair, samples, kernels));
    add_failures(findings, findings.states.back().failures());
    ++findings.done;
    findings.paths.push_back(compare::compare_paths(pair, kernels, kPaths, options.steps));
    ++findings.done;
    for (const compare::Effort& effort : {kConverged, kFast}) {
      if (compared.no_speed) break;
      findings.speeds.push_back(compare::compare_speed(pair, kernels, effort, kSpeedWorlds,
                                                       kMujocoWorlds, kSpeedSteps, kRounds));
      ++findings.done;
      if (!findings.speeds.back().same_hash) {
        findings.failures.push_back("the same steps from the same state ended in different hashes");
      }
    }
    if (kernels.precision != Precision::f64) continue;
    compare::Pair without(files, settings);
    without.disable_contacts();
    findings.free.push_back(compare::compare_free_paths(without, kernels, kFreePaths));
    add_failures(findings, findings.free.back().failures());
    ++findings.done;
  }
}

Json times_of(const std::vector<double>& times) {
  Json list = Json::array();
  for (const double time : times) list.push_back(time < 0 ? Json(nullptr) : Json(time));
  return list;
}

Json to_json(const compare::StateComparison& c) {
  Json quantities = Json::array();
  for (const compare::Quantity& q : c.quantities) {
    quantities.push_back({{"name", q.name},
                          {"states", q.differences.size()},
                          {"largest", q.most()},
                          {"median", q.median()},
                          {"gate", q.gate},
                          {"holds", q.holds()}});
  }
  return {{"precision", to_string(c.kernels.precision)},
          {"isa", to_string(c.kernels.isa)},
          {"states", c.states},
          {"contacts", c.contacts},
          {"rows", c.rows},
          {"other_contacts", c.other_contacts},
          {"uncertain", c.uncertain},
          {"other_points", c.other_points},
          {"quantities", quantities}};
}

Json to_json(const Findings& findings, const CompareOptions& compared) {
  const JobOptions& options = compared.job;
  Json states = Json::array(), paths = Json::array(), speeds = Json::array();
  Json free = nullptr;
  for (const auto& one : findings.states) states.push_back(to_json(one));
  for (const auto& one : findings.paths) {
    paths.push_back({{"precision", to_string(one.kernels.precision)},
                     {"steps", one.steps},
                     {"dt", one.dt},
                     {"apart", compare::kApart},
                     {"moved", compare::kMoved},
                     {"seconds_from_mujoco", times_of(one.ours)},
                     {"seconds_of_mujoco_moved", times_of(one.own)}});
  }
  for (const auto& one : findings.free) {
    free = {{"steps", one.steps},
            {"gate", compare::kFollowed},
            {"from_mujoco", one.ours},
            {"mujoco_moved", one.own}};
  }
  for (const auto& one : findings.speeds) {
    speeds.push_back({{"precision", to_string(one.kernels.precision)},
                      {"isa", to_string(one.kernels.isa)},
                      {"worlds", one.worlds},
                      {"mujoco_worlds", one.mujoco_worlds},
                      {"steps", one.steps},
                      {"tolerance", one.effort.tolerance},
                      {"iterations", one.effort.iterations},
                      {"line_search_iterations", one.effort.line_search_iterations},
                      {"world_steps_per_s", one.ours},
                      {"mujoco_world_steps_per_s", one.mujoco},
                      {"mujoco_batch_world_steps_per_s", one.mujoco_batch},
                      {"contacts_per_world", one.contacts},
                      {"mujoco_contacts_per_world", one.mujoco_contacts},
                      {"hash", hex(one.hash)}});
  }
  Json json = {{"model", options.scene},           {"mujoco", mj_versionString()},
               {"machine", tools::machine_line()}, {"seed", options.seed.value_or(0)},
               {"tolerance", compared.tolerance},  {"states", states},
               {"not_compared", kNotCompared},     {"paths", paths},
               {"paths_without_contacts", free},   {"speed", speeds},
               {"failures", findings.failures}};
  if (findings.done < findings.all) json["interrupted"] = tools::interrupt_name();
  return json;
}

std::string share(int count, int states) { return fmt::format("{:.2g}", double(count) / states); }

void print_states(const compare::StateComparison& c) {
  fmt::print("\n{}, {}: {} contacts and {} rows of constraints per state\n",
             to_string(c.kernels.precision), counted(c.states, "state"),
             share(c.contacts, c.states), share(c.rows, c.states));
  fmt::print("  {:<26}{:>8}{:>12}{:>12}{:>10}\n", "relative difference", "states", "largest",
             "median", "gate");
  for (const compare::Quantity& q : c.quantities) {
    if (q.differences.empty()) {
      fmt::print("  {:<26}{:>8}\n", q.name, 0);
      continue;
    }
    fmt::print("  {:<26}{:>8}{:>12.2g}{:>12.2g}{:>10.0e}{}\n", q.name, q.differences.size(),
               q.most(), q.median(), q.gate, q.holds() ? "" : "  FAILS");
  }
  fmt::print(
      "  different number of contacts in {}; excluded for rounding at the margin {}, for\n"
      "  shapes whose contact points differ from MuJoCo's {}\n",
      counted(c.other_contacts, "state"), c.uncertain, c.other_points);
}

void print_paths(const compare::Parting& p) {
  const auto text = [&](const std::vector<double>& times) {
    const double time = compare::Parting::median(times);
    const auto kept = std::count_if(times.begin(), times.end(), [](double t) { return t < 0; });
    return fmt::format("{}, {} of {} never",
                       time < 0 ? fmt::format("more than {:.3g} s", p.steps * p.dt)
                                : fmt::format("{:.3g} s", time),
                       kept, times.size());
  };
  fmt::print("\n{}, {} of {:.3g} s: median time until paths differ by {:.0e}\n",
             to_string(p.kernels.precision), counted(p.steps, "step"), p.dt, compare::kApart);
  fmt::print("  manyworlds and MuJoCo                  {}\n", text(p.ours));
  fmt::print("  MuJoCo and MuJoCo, moved by {:.0e}      {}\n", compare::kMoved, text(p.own));
}

void print_free(const compare::FreePaths& p) {
  const double own = *std::max_element(p.own.begin(), p.own.end());
  fmt::print("\nf64, {} without contacts: error {:.2g} (MuJoCo itself, moved by {:.0e}: {:.2g})\n",
             counted(p.steps, "step"), p.most(), compare::kMoved, own);
}

void print_speed(const compare::Speed& s) {
  const double ours = median(s.ours), loop = median(s.mujoco), batch = median(s.mujoco_batch);
  fmt::print(
      "\n{} {}, {}, 1 thread, tolerance {:.0e}, {} of at most {} line-search steps, median of {} "
      "rounds\n"
      "  manyworlds  {:>8} world-steps/s, {:.2f} contacts per world, hash {}\n"
      "  MuJoCo      {:>8} world-steps/s, {:.2f} contacts per world: {:.1f} x\n"
      "    by batch  {:>8} world-steps/s: {:.1f} x\n",
      to_string(s.kernels.isa), to_string(s.kernels.precision), counted(s.worlds, "world"),
      s.effort.tolerance, counted(s.effort.iterations, "iteration"),
      s.effort.line_search_iterations, s.rounds, with_prefix(ours), s.contacts, hex(s.hash),
      with_prefix(loop), s.mujoco_contacts, ours / loop, with_prefix(batch), ours / batch);
}

int tell_interrupted(const Findings& findings) {
  std::fflush(stdout);
  tools::tell("manyworlds: interrupted by {} after {} of {}\n", tools::interrupt_name(),
              findings.done, counted(findings.all, "comparison"));
  return tools::interrupt_code();
}

}  // namespace

int compare_command(const CompareOptions& compared) {
  const JobOptions& options = compared.job;
  const MjcfFiles files = read_mjcf_files(options.scene, options.mjcf);
  Findings findings;
  const tools::Interruptible interruptible;
  try {
    find(files, compared, findings);
  } catch (const tools::Interrupted&) {        // what was compared by then is printed
  } catch (const std::runtime_error& error) {  // MjcfError, MujocoFailure
    throw InputError(error.what());
  } catch (const std::invalid_argument& error) {
    throw InputError(fmt::format("{}: {}", options.scene, error.what()));
  }
  const bool whole = findings.done == findings.all;
  if (options.json) {
    fmt::print("{}\n", to_json(findings, compared).dump(2));
    if (!whole) return tell_interrupted(findings);
    return findings.failures.empty() ? kOk : kWorldLost;
  }
  fmt::print(
      "{} compared with MuJoCo {}, both with Newton's method to {:.0e} (float32 to 1e-07), seed "
      "{}\n",
      options.scene, mj_versionString(), compared.tolerance, options.seed.value_or(0));
  for (const auto& one : findings.states) print_states(one);
  fmt::print("\nnot compared: {}\n", kNotCompared);
  for (const auto& one : findings.paths) print_paths(one);
  for (const auto& one : findings.free) print_free(one);
  for (const auto& one : findings.speeds) print_speed(one);
  if (findings.failures.empty()) {
    fmt::print("\nall gates hold{}\n", whole ? "" : " so far");
    return whole ? kOk : tell_interrupted(findings);
  }
  fmt::print("\n{} fail\n", counted(static_cast<long long>(findings.failures.size()), "gate"));
  std::fflush(stdout);
  for (const std::string& failure : findings.failures) tools::tell("manyworlds: {}\n", failure);
  return whole ? kWorldLost : tell_interrupted(findings);
}

}  // namespace manyworlds::cli

#else

namespace manyworlds::cli {

int compare_command(const CompareOptions&) { throw not_built("compare", "MJCF", "MW_MJCF=ON"); }

}  // namespace manyworlds::cli

#endif
