#include "tools/report/invariants.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/base/interrupt.hpp"
#include "tools/base/text.hpp"

namespace manyworlds::report {
namespace {

using invariants::Family, invariants::RunOptions, invariants::Units;

std::vector<std::pair<Units, Precision>> settings_of(const InvariantsOptions& options) {
  std::vector<std::pair<Units, Precision>> out;
  for (const auto& [units, precision] :
       {std::pair(Units::similar, Precision::f32), std::pair(Units::earth, Precision::f32),
        std::pair(Units::similar, Precision::f64)}) {
    if (options.units.value_or(units) != units) continue;
    if (options.precision.value_or(precision) == precision) out.emplace_back(units, precision);
  }
  // Not one of the default settings.
  if (out.empty()) out.emplace_back(*options.units, *options.precision);
  return out;
}

bool is_chosen(const Family& family, const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return one_word(name) == one_word(family.id) || name == to_string(family.law);
  });
}

double ratio_of(const InvariantRow& row) {
  if (row.limit() > 0) return row.outcome.worst / row.limit();
  return row.outcome.worst > 0 ? std::numeric_limits<double>::infinity() : 0;
}

}  // namespace

double InvariantRow::limit() const {
  const bool own = options.precision == Precision::f64 && family.limit_f64 > 0;
  return own ? family.limit_f64 : family.limit;
}
double InvariantRow::share() const {
  return static_cast<double>(outcome.broken) / std::max(1, outcome.worlds);
}
bool InvariantRow::passed() const { return share() <= kMostBroken; }

std::string one_word(std::string id) {
  std::erase_if(id, [](char c) { return c == ',' || c == ':'; });
  std::replace(id.begin(), id.end(), ' ', '-');
  return id;
}

std::vector<std::string> family_names() {
  std::vector<std::string> laws, ids;
  for (const Family& f : families_of({})) {
    const std::string law = to_string(f.law);
    if (std::count(laws.begin(), laws.end(), law) == 0) laws.push_back(law);
    ids.push_back(one_word(f.id));
  }
  laws.insert(laws.end(), ids.begin(), ids.end());
  return laws;
}

std::vector<Family> families_of(const std::vector<std::string>& names) {
  std::vector<Family> out = invariants::families();
  if (!names.empty()) std::erase_if(out, [&](const Family& f) { return !is_chosen(f, names); });
  std::stable_sort(out.begin(), out.end(),
                   [](const Family& a, const Family& b) { return a.law < b.law; });
  return out;
}

std::vector<InvariantRow> run_invariants(
    const InvariantsOptions& options, const std::function<void(const std::string&, double)>& tell) {
  const std::vector<Family> families = families_of(options.families);
  const auto settings = settings_of(options);
  const double count = static_cast<double>(families.size() * settings.size());
  std::vector<InvariantRow> rows;
  for (const Family& family : families) {
    for (const auto& [units, precision] : settings) {
      tell(fmt::format("{} {} {}", family.id, to_string(units), to_string(precision)),
           static_cast<double>(rows.size()) / count);
      RunOptions run;
      run.seed = options.seed, run.kinds = options.kinds;
      run.units = units, run.precision = precision;
      try {
        rows.push_back({family, run, invariants::run(family, run)});
      } catch (const tools::Interrupted&) {
        return rows;
      }
    }
  }
  return rows;
}

const InvariantRow* worst_row(const std::vector<InvariantRow>& rows) {
  const auto less = [](const InvariantRow& a, const InvariantRow& b) {
    if (a.family.required != b.family.required) return b.family.required;
    if (a.share() != b.share()) return a.share() < b.share();
    return ratio_of(a) < ratio_of(b);
  };
  const auto worst = std::max_element(rows.begin(), rows.end(), less);
  return worst == rows.end() ? nullptr : &*worst;
}

std::string command_of(const InvariantRow& row) {
  const std::string family = one_word(row.family.id);
  const int world = row.outcome.worst_world;
  const std::string file = fmt::format("{}-{}.h5", family, world);
  return fmt::format(
      "manyworlds report invariants --families {} --units {} --precision {} --seed {} --world {} "
      "--record {}",
      tools::shell_word(family), to_string(row.options.units), to_string(row.options.precision),
      row.options.seed, world, tools::shell_word(file));
}

nlohmann::ordered_json to_json(const std::vector<InvariantRow>& rows) {
  nlohmann::ordered_json out = nlohmann::ordered_json::array();
  for (const InvariantRow& r : rows) {
    const invariants::Outcome& o = r.outcome;
    out.push_back({{"family", r.family.id},
                   {"law", to_string(r.family.law)},
                   {"title", r.family.title},
                   {"criterion", r.family.criterion},
                   {"unit", r.family.unit},
                   {"units", to_string(r.options.units)},
                   {"precision", to_string(r.options.precision)},
                   {"worlds", o.worlds},
                   {"broken", o.broken},
                   {"share", r.share()},
                   {"silent", o.silent},
                   {"lost", o.lost},
                   {"limit", r.limit()},
                   {"worst", std::isfinite(o.worst) ? nlohmann::ordered_json(o.worst) : nullptr},
                   {"worst_world", o.worst_world},
                   {"seed", r.options.seed},
                   {"required", r.family.required},
                   {"passed", r.passed()},
                   {"command", command_of(r)}});
  }
  return out;
}

}  // namespace manyworlds::report
