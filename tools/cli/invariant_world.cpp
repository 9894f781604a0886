#include "invariant_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "not_built.hpp"
#include "recording.hpp"
#include "tools/base/interrupt.hpp"
#include "tools/base/tell.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::cli {
namespace {

using invariants::Family;

constexpr int kContacts = 1024;  // points of a step at most

Family one_family(const std::vector<std::string>& names) {
  const std::vector<Family> found = report::families_of(names);
  if (found.size() == 1) return found.front();
  std::string all;
  for (const Family& f : found) all += (all.empty() ? "" : ", ") + report::one_word(f.id);
  throw InputError(fmt::format(
      "--world: needs one family, --families selects {}; expected one of {}", found.size(), all));
}

// A world, with the values of its law after each step.
struct OneWorld {
  Family family;
  invariants::RunOptions run;
  int world;
  double limit, dt;
  std::vector<double> values;

  double worst() const { return *std::max_element(values.begin(), values.end()); }
  // The first step after which the value exceeds the limit.
  std::optional<std::ptrdiff_t> first_broken() const {
    const auto found =
        std::find_if(values.begin(), values.end(), [&](double v) { return v > limit; });
    if (found == values.end()) return std::nullopt;
    return found - values.begin();
  }
};

nlohmann::ordered_json number(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nullptr;
}

nlohmann::ordered_json to_json(const OneWorld& one) {
  nlohmann::ordered_json values = nlohmann::ordered_json::array();
  for (const double v : one.values) values.push_back(number(v));
  const auto broken = one.first_broken();
  return {{"family", one.family.id},
          {"law", to_string(one.family.law)},
          {"title", one.family.title},
          {"criterion", one.family.criterion},
          {"unit", one.family.unit},
          {"units", to_string(one.run.units)},
          {"precision", to_string(one.run.precision)},
          {"seed", one.run.seed},
          {"world", one.world},
          {"steps", one.values.size() - 1},
          {"dt", one.dt},
          {"limit", one.limit},
          {"worst", number(one.worst())},
          {"first_broken", broken ? nlohmann::ordered_json(*broken) : nullptr},
          {"values", std::move(values)}};
}

void print_text(const OneWorld& one, bool with_values) {
  const std::string unit = one.family.unit.empty() ? "" : ' ' + one.family.unit;
  fmt::print("{}, world {}, {} units, {}, seed {}\n", report::one_word(one.family.id), one.world,
             to_string(one.run.units), to_string(one.run.precision), one.run.seed);
  fmt::print("  {:<13}{}\n", "scenes", one.family.title);
  fmt::print("  {:<13}{}\n", "law", one.family.criterion);
  fmt::print("  {:<13}{} of {:.6g} s\n", "steps", one.values.size() - 1, one.dt);
  fmt::print("  {:<13}{:.4g}{}, limit {:.4g}{}\n", "value", one.worst(), unit, one.limit, unit);
  if (const auto step = one.first_broken()) {
    fmt::print("  {:<13}after step {}, at {:.6g} s\n", "broken", *step,
               static_cast<double>(*step) * one.dt);
  }
  if (!with_values) return;
  fmt::print("\n  {:>6} {:>14} {:>12}\n", "step", "time, s", "value");
  for (std::size_t i = 0; i < one.values.size(); ++i) {
    fmt::print("  {:>6} {:>14.6g} {:>12.4g}\n", i, static_cast<double>(i) * one.dt, one.values[i]);
  }
}

// Steps the world again and records it. Returns a line for people, or nothing if interrupted.
std::optional<std::string> record(const OneWorld& one, const std::string& file) {
  Batch batch = invariants::batch_of(one.family, one.run, one.world);
  JobOptions job;
  job.record = file, job.record_every = 1, job.record_contacts = kContacts;
  JobRecorder recorder(batch, job);
  for (std::size_t i = 1; i < one.values.size(); ++i) {
    batch.step();
    if (tools::interrupted() != 0) return std::nullopt;
  }
  const std::string recorded = recorder.finish(batch);
  if (!recorder.failure().empty()) throw InputError(recorder.failure());
  return recorded;
}

int tell_interrupted() {
  tools::tell("manyworlds: interrupted by {}\n", tools::interrupt_name());
  return tools::interrupt_code();
}

}  // namespace

int invariant_world(const report::InvariantsOptions& what, const ReportOptions& options) {
  const Family family = one_family(what.families);
  const int world = *options.world;
  report::InvariantRow row{family, {}, {}};
  row.options.seed = what.seed;
  row.options.units = what.units.value_or(row.options.units);
  row.options.precision = what.precision.value_or(row.options.precision);
  if (!options.record.empty() && !writes_recordings()) {
    throw not_built("--record", "recordings", "MW_RECORD=ON");
  }
  const tools::Interruptible interruptible;
  OneWorld one{family, row.options, world, row.limit(), 0, {}};
  one.dt = invariants::draw_world(family, one.run, world).scene.options.dt;
  std::optional<std::string> recorded;
  try {
    one.values = invariants::values_of(family, one.run, world);
    if (!options.record.empty()) {
      recorded = record(one, options.record);
      if (!recorded) return tell_interrupted();
    }
  } catch (const tools::Interrupted&) {
    return tell_interrupted();
  }
  const std::string view = "manyworlds view " + tools::shell_word(options.record);
  if (options.json) {
    nlohmann::ordered_json json = to_json(one);
    if (recorded) json["file"] = options.record, json["command"] = view;
    fmt::print("{}\n", json.dump(2));
    return kOk;
  }
  print_text(one, !recorded);
  if (recorded) fmt::print("  {:<13}{}\n\nTo see it: {}\n", "recorded", *recorded, view);
  return kOk;
}

}  // namespace manyworlds::cli
