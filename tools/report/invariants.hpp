// `manyworlds report invariants`: laws of mechanics, checked over families of random scenes
// (tools/invariants).
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "tools/invariants/family.hpp"

namespace manyworlds::report {

// A family in one precision and one choice of units.
struct InvariantRow {
  invariants::Family family;
  invariants::RunOptions options;
  invariants::Outcome outcome;

  double limit() const;
  double share() const;  // of worlds that break the law
  bool passed() const;   // a share of at most kMostBroken
};
inline constexpr double kMostBroken = 1e-3;

struct InvariantsOptions {
  std::vector<std::string> families;  // of family_names(); empty: all
  std::uint64_t seed = 1;
  int kinds = 64;
  // Empty: similar and earth in float32, similar in float64.
  std::optional<invariants::Units> units = {};
  std::optional<Precision> precision = {};
};

// The id as one word: "cluster-2D-linear" for "cluster 2D, linear".
std::string one_word(std::string id);
// The names of laws, then the ids of families, each as one word.
std::vector<std::string> family_names();
// All families of these laws and with these ids, by law. All families if there are no names.
std::vector<invariants::Family> families_of(const std::vector<std::string>& names);

// Ends early, with the rows so far, if interrupted.
std::vector<InvariantRow> run_invariants(
    const InvariantsOptions& options, const std::function<void(const std::string&, double)>& tell);

// The row that breaks its law most. Required rows come first, then the share, then the value
// relative to the limit. None if there are no rows.
const InvariantRow* worst_row(const std::vector<InvariantRow>& rows);
// The command that records the worst world of a row.
std::string command_of(const InvariantRow& row);

nlohmann::ordered_json to_json(const std::vector<InvariantRow>& rows);

}  // namespace manyworlds::report
